// SPDX-License-Identifier: Apache-2.0
#include "models/container_header.h"

#include <charconv>
#include <limits>
#include <set>

#include "dcnn/core/error.h"
#include "dcnn/core/json.h"

namespace dcnn {
namespace {

constexpr std::uint64_t kMostBytes = std::numeric_limits<Index>::max();

template <class Numbers>
std::string bracketed(const Numbers& numbers) {
  std::string text = "[";
  for (const auto number : numbers) text += (text.size() > 1 ? "," : "") + std::to_string(number);
  return text + "]";
}

/// Reads the grammar that header_text() writes and nothing else. Neither depth nor count nor length
/// in a hostile text can cost more than one pass over its bytes.
class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  ContainerHeader read() {
    ContainerHeader header;
    expect(R"({"__metadata__":{)");
    do {
      read_metadata(header);
    } while (accept(","));
    expect("}");
    while (accept(",")) {
      if (header.tensors.size() == kMaxTensors) reject("more than 4096 tensors");
      header.tensors.push_back(read_tensor());
    }
    expect("}");
    return header;
  }

 private:
  void read_metadata(ContainerHeader& header) {
    const std::string key = read_string();
    expect(":");
    if (!header.metadata.emplace(key, read_string()).second) reject("a key is given twice");
  }

  TensorEntry read_tensor() {
    TensorEntry tensor;
    tensor.name = read_string();
    if (!names_.insert(tensor.name).second) reject("a tensor's name is given twice");
    expect(R"(:{"dtype":)");
    tensor.dtype = read_string();
    expect(R"(,"shape":[)");
    if (!accept("]")) {
      do {
        if (tensor.shape.size() == kMaxDimensions) reject("a tensor of more than 8 dimensions");
        tensor.shape.push_back(static_cast<Index>(read_number()));
      } while (accept(","));
      expect("]");
    }
    expect(R"(,"data_offsets":[)");
    tensor.begin = read_number();
    expect(",");
    tensor.end = read_number();
    expect("]}");
    return tensor;
  }

  std::string read_string() {
    if (!text_.substr(place_).starts_with('"')) reject("a string is missing");
    std::size_t end = place_ + 1;
    while (end < text_.size() && text_[end] != '"') end += text_[end] == '\\' ? 2 : 1;
    if (end >= text_.size()) reject("a string has no end");
    const auto token = text_.substr(place_, end + 1 - place_);
    place_ = end + 1;
    try {
      return parse_json(token, where_, Exit::kModel).get<std::string>();
    } catch (const Error&) {
      reject("a string is not valid JSON in UTF-8");
    }
  }

  std::uint64_t read_number() {
    std::uint64_t number = 0;
    const char* end = text_.data() + text_.size();
    const auto [rest, error] = std::from_chars(text_.data() + place_, end, number);
    if (error != std::errc() || number > kMostBytes) reject("a size or offset is out of range");
    place_ = static_cast<std::size_t>(rest - text_.data());
    return number;
  }

  bool accept(std::string_view word) {
    if (!text_.substr(place_).starts_with(word)) return false;
    place_ += word.size();
    return true;
  }

  void expect(std::string_view word) {
    if (!accept(word)) reject("'" + std::string(word) + "' is missing");
  }

  [[noreturn]] void reject(const std::string& fault) const {
    reject_model(where_, "header, byte " + std::to_string(place_) + ": " + fault);
  }

  std::string_view text_;
  const std::string& where_;
  std::size_t place_ = 0;  // never beyond text_.size()
  std::set<std::string> names_{"__metadata__"};
};

/// Bytes of a tensor, or more than any file has when the product does not fit.
std::uint64_t tensor_bytes(const TensorEntry& tensor) {
  std::uint64_t bytes = value_bytes(tensor.dtype);
  for (const Index extent : tensor.shape) {
    std::uint64_t product = 0;
    const auto factor = static_cast<std::uint64_t>(extent);
    if (__builtin_mul_overflow(bytes, factor, &product)) return kMostBytes;
    bytes = product;
  }
  return bytes;
}

void check_tiling(const ContainerHeader& header, std::uint64_t data_bytes,
                  const std::string& where) {
  std::uint64_t place = 0;
  for (const auto& tensor : header.tensors) {
    const std::string name = "tensor " + quoted(tensor.name);
    if (value_bytes(tensor.dtype) == 0) reject_model(where, name + ": unknown dtype");
    if (tensor.begin != place || tensor.end < place || tensor.end > data_bytes) {
      reject_model(where, name + ": its data overlap, leave a gap or lie outside the file");
    }
    if (tensor_bytes(tensor) != tensor.end - tensor.begin) {
      reject_model(where, name + ": its shape does not fit its data");
    }
    place = tensor.end;
  }
  if (place != data_bytes) reject_model(where, "bytes after the last tensor");
}

}  // namespace

std::string quoted(const std::string& text) {
  std::string dumped = Json(text).dump();  // with U+FFFD for what is no UTF-8
  require(Json::parse(dumped) == text, Exit::kFailure,
          "cannot write a model file: a name or description in it is not UTF-8");
  return dumped;
}

void reject_model(const std::string& where, const std::string& fault) {
  fail(Exit::kModel, where, ": ", fault,
       "; the file is damaged or was changed: copy it again or train anew");
}

std::uint64_t value_bytes(std::string_view dtype) {
  if (dtype == "F32") return 4;
  return dtype == "F64" || dtype == "I64" ? 8 : 0;
}

std::string header_text(const ContainerHeader& header) {
  std::string text = R"({"__metadata__":{)";
  for (const auto& [key, value] : header.metadata) {
    if (text.back() != '{') text += ",";
    text += quoted(key) + ":" + quoted(value);
  }
  text += "}";
  for (const auto& tensor : header.tensors) {
    text += "," + quoted(tensor.name) + R"(:{"dtype":)" + quoted(tensor.dtype) + R"(,"shape":)" +
            bracketed(tensor.shape) + R"(,"data_offsets":)" +
            bracketed(std::vector<std::uint64_t>{tensor.begin, tensor.end}) + "}";
  }
  text += "}";
  return text.append((8 - text.size() % 8) % 8, ' ');
}

ContainerHeader parse_header(std::string_view text, std::uint64_t data_bytes,
                             const std::string& where) {
  auto header = HeaderReader(text, where).read();
  check_tiling(header, data_bytes, where);
  // Whatever is left to chance (padding, escapes, leading zeros, order of keys) has one spelling.
  if (header_text(header) != text) reject_model(where, "header: not written as this program does");
  return header;
}

}  // namespace dcnn
