// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "data/text.h"
#include "import/bytes.h"
#include "import/decompress.h"
#include "import/message_topics.h"
#include "import/readers.h"

namespace dcnn {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

// Opcodes.
constexpr std::uint8_t kFooter = 2, kSchema = 3, kChannel = 4, kMessage = 5, kChunk = 6,
                       kDataEnd = 15;

struct McapSchema {
  std::string name, encoding, text;
};

class McapReader {
 public:
  McapReader(const std::filesystem::path& path, LogBuilder& builder)
      : file_(path),
        topics_(builder, file_.name()),
        expand_(file_.name(), file_.size()),
        builder_(builder) {}

  void read() {
    require(file_.take(kMagic.size()) == kMagic, Exit::kData, file_.name(), ": is no MCAP file");
    try {
      while (next_record()) {
      }
    } catch (const Error& error) {
      if (!builder_.options().accept_truncated) throw;
      builder_.log().notes.push_back(std::string("taken up to where it ends: ") + error.what());
    }
    topics_.finish();
    builder_.log().format = "MCAP";
  }

 private:
  /// False at the end of the data; what follows only repeats it.
  bool next_record() {
    Bytes head(file_.take(9), file_.name());
    const auto opcode = head.number<std::uint8_t>();
    const auto length = head.number<std::uint64_t>();
    if (opcode == kDataEnd || opcode == kFooter) return false;
    if (opcode != kSchema && opcode != kChannel && opcode != kMessage && opcode != kChunk) {
      file_.skip(length);
      return true;
    }
    record(opcode, file_.take(length));
    return true;
  }

  void record(std::uint8_t opcode, std::string_view content) {
    Bytes bytes(content, file_.name());
    if (opcode == kSchema) schema(bytes);
    if (opcode == kChannel) channel(bytes);
    if (opcode == kMessage) message(bytes);
    if (opcode == kChunk) chunk(bytes);
  }

  void schema(Bytes& bytes) {
    const auto id = bytes.number<std::uint16_t>();
    McapSchema schema;
    schema.name = bytes.text32();
    schema.encoding = bytes.text32();
    schema.text = bytes.text32();
    schemas_[id] = std::move(schema);
  }

  void channel(Bytes& bytes) {
    const auto id = bytes.number<std::uint16_t>();
    const auto schema_id = bytes.number<std::uint16_t>();
    const std::string topic(bytes.text32());
    const std::string encoding(bytes.text32());
    if (topics_.known(id)) return;
    const auto schema = schemas_.find(schema_id);
    require(schema_id == 0 || schema != schemas_.end(), Exit::kData, file_.name(), ": topic ",
            shown(topic), " is of a schema that the file does not hold");
    if (schema_id == 0) return topics_.add(id, topic, "", encoding + " without schema", "");
    const McapSchema& found = schema->second;
    const bool ros = found.encoding == "ros2msg" || found.encoding == "ros1msg";
    topics_.add(id, topic, found.name, ros ? encoding : encoding + "/" + found.encoding,
                found.text);
  }

  void message(Bytes& bytes) {
    const auto id = bytes.number<std::uint16_t>();
    bytes.number<std::uint32_t>();  // sequence
    const auto logged = bytes.number<std::uint64_t>();
    bytes.number<std::uint64_t>();  // published
    topics_.message(id, 1e-9 * static_cast<double>(logged), bytes.take(bytes.left()));
  }

  void chunk(Bytes& bytes) {
    require(!inside_chunk_, Exit::kData, file_.name(), ": a chunk lies within a chunk");
    bytes.take(16);  // first and last time
    const auto size = bytes.number<std::uint64_t>();
    const auto crc = bytes.number<std::uint32_t>();
    const std::string kind(bytes.text32());
    const std::string_view packed = bytes.take(bytes.number<std::uint64_t>());
    const std::string_view records = expand_.expand(kind, packed, size);
    require(crc == 0 || crc32(records) == crc, Exit::kData, file_.name(),
            ": a chunk's checksum is wrong; the file is damaged");
    Bytes inner(records, file_.name());
    inside_chunk_ = true;
    while (!inner.ended()) {
      const auto opcode = inner.number<std::uint8_t>();
      const auto length = inner.number<std::uint64_t>();
      record(opcode, inner.take(length));
    }
    inside_chunk_ = false;
  }

  ByteFile file_;
  MessageTopics topics_;
  Decompressor expand_;
  LogBuilder& builder_;
  std::map<std::uint16_t, McapSchema> schemas_;
  bool inside_chunk_ = false;
};

}  // namespace

void read_mcap(const std::filesystem::path& path, LogBuilder& builder) {
  McapReader(path, builder).read();
}

}  // namespace dcnn
