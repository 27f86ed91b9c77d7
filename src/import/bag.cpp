// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "data/text.h"
#include "import/bytes.h"
#include "import/decompress.h"
#include "import/message_topics.h"
#include "import/readers.h"

namespace dcnn {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

constexpr std::uint8_t kBagMessage = 2, kBagChunk = 5, kBagConnection = 7;

/// Fields "name=value" of a record's header.
using BagHeader = std::map<std::string, std::string, std::less<>>;

BagHeader parse_bag_header(std::string_view text, const std::string& place) {
  BagHeader header;
  Bytes bytes(text, place);
  while (!bytes.ended()) {
    const std::string_view field = bytes.text32();
    const std::size_t at = field.find('=');
    require(at != std::string_view::npos, Exit::kData, place, ": a header's field has no '='");
    header[std::string(field.substr(0, at))] = field.substr(at + 1);
  }
  return header;
}

template <class T>
T bag_number(const BagHeader& header, std::string_view name, const std::string& place) {
  const auto found = header.find(name);
  require(found != header.end() && found->second.size() == sizeof(T), Exit::kData, place,
          ": a record lacks its field '", name, "'");
  return Bytes(found->second, place).number<T>();
}

std::string bag_text(const BagHeader& header, std::string_view name) {
  const auto found = header.find(name);
  return found == header.end() ? "" : found->second;
}

class BagReader {
 public:
  BagReader(const std::filesystem::path& path, LogBuilder& builder)
      : file_(path),
        topics_(builder, file_.name()),
        expand_(file_.name(), file_.size()),
        builder_(builder) {}

  void read() {
    require(file_.take(kBagMagic.size()) == kBagMagic, Exit::kData, file_.name(),
            ": is no ROS 1 bag of format 2.0");
    try {
      while (file_.left() > 0) next_record();
    } catch (const Error& error) {
      if (!builder_.options().accept_truncated) throw;
      builder_.log().notes.push_back(std::string("taken up to where it ends: ") + error.what());
    }
    topics_.finish();
    builder_.log().format = "ROS 1 bag";
  }

 private:
  void next_record() {
    const auto header_length = Bytes(file_.take(4), file_.name()).number<std::uint32_t>();
    const BagHeader header = parse_bag_header(file_.take(header_length), file_.name());
    const auto length = Bytes(file_.take(4), file_.name()).number<std::uint32_t>();
    const auto kind = bag_number<std::uint8_t>(header, "op", file_.name());
    if (kind != kBagMessage && kind != kBagChunk && kind != kBagConnection) {
      return file_.skip(length);
    }
    record(kind, header, file_.take(length));
  }

  void record(std::uint8_t kind, const BagHeader& header, std::string_view data) {
    if (kind == kBagConnection) connection(header, data);
    if (kind == kBagMessage) message(header, data);
    if (kind == kBagChunk) chunk(header, data);
  }

  void connection(const BagHeader& header, std::string_view data) {
    const auto id = bag_number<std::uint32_t>(header, "conn", file_.name());
    if (topics_.known(id)) return;
    const BagHeader inner = parse_bag_header(data, file_.name());
    topics_.add(id, bag_text(header, "topic"), bag_text(inner, "type"), "ros1",
                bag_text(inner, "message_definition"));
  }

  void message(const BagHeader& header, std::string_view data) {
    const auto id = bag_number<std::uint32_t>(header, "conn", file_.name());
    const auto time = bag_number<std::uint64_t>(header, "time", file_.name());
    const double received =
        static_cast<double>(time & 0xFFFFFFFFU) + 1e-9 * static_cast<double>(time >> 32);
    topics_.message(id, received, data);
  }

  void chunk(const BagHeader& header, std::string_view data) {
    require(!inside_chunk_, Exit::kData, file_.name(), ": a chunk lies within a chunk");
    const auto size = bag_number<std::uint32_t>(header, "size", file_.name());
    const std::string_view records = expand_.expand(bag_text(header, "compression"), data, size);
    Bytes bytes(records, file_.name());
    inside_chunk_ = true;
    while (!bytes.ended()) {
      const BagHeader inner = parse_bag_header(bytes.text32(), file_.name());
      const std::string_view content = bytes.text32();
      record(bag_number<std::uint8_t>(inner, "op", file_.name()), inner, content);
    }
    inside_chunk_ = false;
  }

  ByteFile file_;
  MessageTopics topics_;
  Decompressor expand_;
  LogBuilder& builder_;
  bool inside_chunk_ = false;
};

}  // namespace

void read_bag(const std::filesystem::path& path, LogBuilder& builder) {
  BagReader(path, builder).read();
}

}  // namespace dcnn
