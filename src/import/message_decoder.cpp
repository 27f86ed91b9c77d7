// SPDX-License-Identifier: Apache-2.0
#include "import/message_decoder.h"

#include <limits>

#include "data/text.h"

namespace dcnn {
namespace {

constexpr std::uint64_t kMostElements = 64;  // of an array whose values are channels
constexpr std::size_t kMostValues = 1024;    // of a message
constexpr std::size_t kMostShapes = 256;     // of a topic
constexpr std::size_t kMostLayouts = 16;     // of a topic, tried one after the other
constexpr std::size_t kMostParts = 4096;     // of a layout that are compared
constexpr std::size_t kTimeBytes = 8, kEncapsulationBytes = 4;

const std::string kNoPath;

bool is_names(const MessageField& field) {
  return field.kind == FieldKind::kString && field.array &&
         (field.name == "name" || field.name == "names" || field.name == "joint_names");
}

bool is_header(const MessageField& field, const MessageSchema& schema) {
  return field.kind == FieldKind::kMessage && !field.array && field.name == "header" &&
         schema.types[static_cast<std::size_t>(field.message)].name == "std_msgs/Header";
}

bool says_si(const std::string& type) {
  const std::string package = type.substr(0, type.find('/'));
  return package == "geometry_msgs" || package == "sensor_msgs" || package == "nav_msgs" ||
         package == "tf2_msgs" || package == "tf";
}

}  // namespace

void MessageDecoder::align(std::size_t size, Bytes* bytes) const {
  if (!cdr_) return;
  const std::size_t step = std::min(size, aligned_);
  const std::size_t over = (bytes->at() - 4) % step;  // the encapsulation's 4 bytes do not count
  if (over != 0) bytes->take(step - over);
}

double MessageDecoder::read_number(const MessageField& field, Bytes* bytes) const {
  align(static_cast<std::size_t>(field.bytes), bytes);
  switch (field.number) {
    case 'b':
      return bytes->number<std::int8_t>();
    case '?':
    case 'B':
      return bytes->number<std::uint8_t>();
    case 'h':
      return bytes->number<std::int16_t>();
    case 'H':
      return bytes->number<std::uint16_t>();
    case 'i':
      return bytes->number<std::int32_t>();
    case 'I':
      return bytes->number<std::uint32_t>();
    case 'q':
      return static_cast<double>(bytes->number<std::int64_t>());
    case 'Q':
      return static_cast<double>(bytes->number<std::uint64_t>());
    case 'f':
      return static_cast<double>(bytes->number<float>());
    default:
      return bytes->number<double>();
  }
}

double MessageDecoder::read_time(const MessageField& field, Bytes* bytes) const {
  align(4, bytes);
  const double seconds = field.number == 'i' ? static_cast<double>(bytes->number<std::int32_t>())
                                             : static_cast<double>(bytes->number<std::uint32_t>());
  return seconds + 1e-9 * bytes->number<std::uint32_t>();
}

std::uint64_t MessageDecoder::read_count(Bytes* bytes) {
  align(4, bytes);
  layout_.fix(bytes->at(), 4);
  return bytes->number<std::uint32_t>();
}

std::string_view MessageDecoder::read_string(Bytes* bytes, bool tells) {
  const std::uint64_t length = read_count(bytes);
  if (tells) layout_.fix(bytes->at(), static_cast<std::size_t>(length));
  std::string_view text = bytes->take(length);
  while (cdr_ && !text.empty() && text.back() == '\0') text.remove_suffix(1);
  return text;
}

void MessageDecoder::skip_numbers(const MessageField& field, std::uint64_t count,
                                  Bytes* bytes) const {
  if (count == 0) return;
  align(static_cast<std::size_t>(field.bytes), bytes);
  bytes->take(count * static_cast<std::uint64_t>(field.bytes));
}

void MessageDecoder::value(double number, const std::string& path) {
  sample_.values.push_back(number);
  if (named_) sample_.names.push_back(path);
}

void MessageDecoder::read_header(const MessageType& type, Bytes* bytes) {
  for (const MessageField& field : type.fields) {
    if (field.kind == FieldKind::kTime) {
      sample_.stamp = read_time(field, bytes);
      layout_.set_stamp(bytes->at() - kTimeBytes, field.number == 'i' ? 'T' : 't');
    }
    if (field.kind == FieldKind::kNumber) read_number(field, bytes);
    if (field.kind == FieldKind::kString) sample_.frame = read_string(bytes, true).substr(0, 256);
  }
  sample_.shape += '<' + sample_.frame + '>';
}

void MessageDecoder::read_element(const MessageField& field, const std::string& path, Bytes* bytes,
                                  bool keep) {
  if (field.kind == FieldKind::kMessage) {
    read_message(schema_.types[static_cast<std::size_t>(field.message)], path, bytes, keep);
  } else if (field.kind == FieldKind::kString) {
    const bool child = field.name == "child_frame_id";
    const std::string_view text = read_string(bytes, child);
    if (child && sample_.child.empty()) {
      sample_.child = text.substr(0, 256);
      sample_.shape += '>' + sample_.child;
    }
  } else {
    const bool time = field.kind == FieldKind::kTime;
    const double number = time ? read_time(field, bytes) : read_number(field, bytes);
    if (!keep || sample_.values.size() >= kMostValues) return;
    value(number, path);
    const char seconds = field.number == 'i' ? 'T' : 't';
    const std::size_t size = time ? kTimeBytes : static_cast<std::size_t>(field.bytes);
    layout_.add_value(bytes->at() - size, time ? seconds : field.number);
  }
}

void MessageDecoder::read_field(const MessageField& field, const std::string& path, Bytes* bytes,
                                bool keep, std::vector<std::string>* labels) {
  if (!field.array) return read_element(field, path, bytes, keep);
  std::uint64_t count = static_cast<std::uint64_t>(field.length);
  if (field.length < 0) {
    count = read_count(bytes);
    sample_.shape += std::to_string(count) + ',';
  }
  const bool few = count <= kMostElements && !field.name.ends_with("covariance");
  if (field.kind == FieldKind::kNumber && (!few || !keep)) return skip_numbers(field, count, bytes);
  const bool names = is_names(field) && few;
  for (std::uint64_t k = 0; k < count; ++k) {
    if (names) {
      labels->emplace_back(read_string(bytes, true).substr(0, 256));
      sample_.shape += labels->back() + ',';
      continue;
    }
    std::string element = kNoPath;
    if (named_) {
      const bool labelled = labels->size() == count;
      element = path + '[' + (labelled ? (*labels)[k] : std::to_string(k)) + ']';
    }
    const std::size_t before = bytes->at();
    read_element(field, element, bytes, keep && few);
    if (bytes->at() == before) return;  // messages without fields: any number of them is nothing
  }
}

void MessageDecoder::read_message(const MessageType& type, const std::string& path, Bytes* bytes,
                                  bool keep) {
  std::vector<std::string> labels;
  ++depth_;
  if (type.fields.empty() && cdr_) bytes->take(1);  // C++ has no empty struct, and so has CDR
  for (const MessageField& field : type.fields) {
    if (depth_ == 1 && is_header(field, schema_)) {
      read_header(schema_.types[static_cast<std::size_t>(field.message)], bytes);
      continue;
    }
    const std::string inner = !named_        ? kNoPath
                              : path.empty() ? field.name
                                             : path + '.' + field.name;
    read_field(field, inner, bytes, keep, &labels);
  }
  --depth_;
}

/// Only a list of stamped messages, as tf.
bool MessageDecoder::is_list() const {
  const auto& fields = schema_.types[0].fields;
  if (fields.size() != 1 || !fields[0].array || fields[0].length >= 0 ||
      fields[0].kind != FieldKind::kMessage) {
    return false;
  }
  const auto& inner = schema_.types[static_cast<std::size_t>(fields[0].message)].fields;
  return !inner.empty() && is_header(inner[0], schema_);
}

void MessageDecoder::start(Bytes* bytes) {
  if (!cdr_) return;
  const std::string_view head = bytes->take(4);
  const auto kind = static_cast<std::uint8_t>(head[1]);
  const bool plain = head[0] == 0 && (kind <= 1 || kind == 6 || kind == 7);
  require(plain, Exit::kData, bytes->place(), ": a message of ", shown(topic_),
          " has the encoding ", static_cast<int>(kind), ", which is not plain CDR");
  aligned_ = kind <= 1 ? 8 : 4;  // XCDR2 aligns to 4 at most
  bytes->set_big_endian(kind % 2 == 0);
}

void MessageDecoder::read_sample(const MessageType& type, Bytes* bytes) {
  sample_.values.clear();
  sample_.names.clear();
  sample_.shape.clear();
  sample_.frame.clear();
  sample_.child.clear();
  sample_.stamp = std::numeric_limits<double>::quiet_NaN();
  layout_ = MessageLayout();
  depth_ = 0;
  read_message(type, kNoPath, bytes, true);
}

LogStream MessageDecoder::describe(const MessageType& type) const {
  LogStream stream;
  stream.name = topic_;
  if (!sample_.child.empty()) stream.name += " " + sample_.frame + ">" + sample_.child;
  if (sample_.child.empty() && !streams_.empty()) {
    stream.name += "#" + std::to_string(streams_.size() + 1);
  }
  stream.type = type.name;
  stream.frame = sample_.frame;
  stream.child = sample_.child;
  stream.si = says_si(type.name);
  for (const std::string& name : sample_.names) {
    LogChannel channel;
    channel.name = name;
    stream.channels.push_back(std::move(channel));
  }
  return stream;
}

std::optional<std::size_t> MessageDecoder::add_sample(const MessageType& type, const Bytes& before,
                                                      double received, LogBuilder& builder) {
  auto found = streams_.find(sample_.shape);
  if (found == streams_.end()) {
    // What changes with every message is no signal.
    if (streams_.size() >= kMostShapes) return std::nullopt;
    Bytes again = before;
    named_ = true;
    read_sample(type, &again);
    named_ = false;
    const std::size_t stream =
        builder.stream("topic:" + topic_ + '\n' + sample_.shape, [&] { return describe(type); });
    found = streams_.emplace(sample_.shape, stream).first;
  }
  builder.add(found->second, sample_.stamp, received, sample_.values);
  return found->second;
}

bool MessageDecoder::decode_by_layout(std::string_view message, double received,
                                      LogBuilder& builder) {
  for (const MessageLayout& layout : layouts_) {
    if (!layout.fits(message)) continue;
    layout.read(message, &sample_.values);
    const double stamp =
        layout.has_stamp() ? layout.stamp(message) : std::numeric_limits<double>::quiet_NaN();
    builder.add(layout.stream(), stamp, received, sample_.values);
    return true;
  }
  return false;
}

void MessageDecoder::decode(std::string_view message, double received, const std::string& place,
                            LogBuilder& builder) {
  if (decode_by_layout(message, received, builder)) return;
  Bytes bytes(message, place);
  start(&bytes);
  const MessageType* type = &schema_.types[0];
  std::uint64_t count = 1;
  if (list_) {
    align(4, &bytes);
    count = bytes.number<std::uint32_t>();
    type = &schema_.types[static_cast<std::size_t>(type->fields[0].message)];
  }
  for (std::uint64_t k = 0; k < count; ++k) {
    const Bytes before = bytes;
    read_sample(*type, &bytes);
    const auto stream = add_sample(*type, before, received, builder);
    if (list_ || !stream || layouts_.size() >= kMostLayouts) continue;
    if (cdr_) layout_.fix(0, kEncapsulationBytes);
    layout_.finish(message, cdr_ && message[1] % 2 == 0, *stream);
    if (layout_.parts() <= kMostParts) layouts_.push_back(std::move(layout_));
  }
}

}  // namespace dcnn
