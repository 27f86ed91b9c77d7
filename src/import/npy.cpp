// SPDX-License-Identifier: Apache-2.0
// NumPy's arrays (numpy.lib.format, versions 1 to 3), alone and in zip files.
#include <algorithm>

#include "data/text.h"
#include "import/bytes.h"
#include "import/decompress.h"
#include "import/npy_header.h"
#include "import/number_arrays.h"
#include "import/readers.h"

namespace dcnn {
namespace {

constexpr std::string_view kNpyMagic("\x93NUMPY", 6);
constexpr std::uint64_t kMostZipEntries = 10000;

NumberArray parse_npy(const std::string& name, std::string_view file, const std::string& place) {
  Bytes bytes(file, place);
  require(bytes.take(kNpyMagic.size()) == kNpyMagic, Exit::kData, place, ": is no array of NumPy");
  const auto major = bytes.number<std::uint8_t>();
  bytes.number<std::uint8_t>();
  const std::uint64_t length =
      major == 1 ? bytes.number<std::uint16_t>() : bytes.number<std::uint32_t>();
  const NpyHeader header = parse_npy_header(bytes.take(length), place);
  const std::string_view data = bytes.take(header.bytes());
  NumberArray array;
  for (const NpyField& field : header.fields) {
    const std::string stem = field.name.empty() ? name : field.name;
    if (header.matrix > 0) {
      for (auto& element : matrix_names(stem, header.matrix, header.fortran)) {
        array.channels.push_back(std::move(element));
      }
      continue;
    }
    for (Index column = 0; column < header.columns; ++column) {
      array.channels.push_back(element_name(stem, column, header.columns));
    }
  }
  array.rows = header.rows;
  array.columns.resize(array.channels.size());
  std::vector<double> row;
  for (Index k = 0; k < header.rows; ++k) {
    row.clear();
    header.read_row(data, k, place, &row);
    for (std::size_t c = 0; c < row.size(); ++c) array.columns[c].push_back(row[c]);
  }
  return array;
}

struct ZipEntry {
  std::string name;
  std::uint16_t method = 0;
  std::uint64_t packed = 0, size = 0, offset = 0;
  std::uint32_t crc = 0;
};

/// Sizes of 64 bits stand in an extra field where the plain ones are all ones.
void read_zip64(std::string_view extra, ZipEntry* entry, const std::string& place) {
  Bytes bytes(extra, place);
  while (bytes.left() >= 4) {
    const auto id = bytes.number<std::uint16_t>();
    const std::string_view field = bytes.take(bytes.number<std::uint16_t>());
    if (id != 1) continue;
    Bytes values(field, place);
    for (std::uint64_t* value : {&entry->size, &entry->packed, &entry->offset}) {
      if (*value == 0xFFFFFFFFU) *value = values.number<std::uint64_t>();
    }
  }
}

std::vector<ZipEntry> zip_directory(ByteFile& file) {
  constexpr std::uint64_t kEndBytes = 22, kLongestComment = 65535;
  const std::uint64_t tail = std::min(file.size(), kEndBytes + kLongestComment);
  file.seek(file.size() - tail);
  const std::string end(file.take(tail));
  const std::size_t at = end.rfind("PK\x05\x06");
  require(at != std::string::npos && end.size() - at >= kEndBytes, Exit::kData, file.name(),
          ": is no whole zip file; it is cut off or damaged");
  Bytes bytes(std::string_view(end).substr(at + 10), file.name());
  std::uint64_t count = bytes.number<std::uint16_t>();
  bytes.number<std::uint32_t>();
  const std::uint64_t offset = bytes.number<std::uint32_t>();
  require(count <= kMostZipEntries && offset != 0xFFFFFFFFU, Exit::kData, file.name(),
          ": is a zip file of more than 4 GB or ", kMostZipEntries, " arrays");
  file.seek(offset);
  std::vector<ZipEntry> entries;
  for (; count > 0; --count) {
    const std::string head(file.take(46));
    require(head.starts_with("PK\x01\x02"), Exit::kData, file.name(), ": its directory is damaged");
    Bytes fields(std::string_view(head).substr(8), file.name());
    ZipEntry entry;
    const auto flags = fields.number<std::uint16_t>();
    entry.method = fields.number<std::uint16_t>();
    fields.number<std::uint32_t>();  // time and date
    entry.crc = fields.number<std::uint32_t>();
    entry.packed = fields.number<std::uint32_t>();
    entry.size = fields.number<std::uint32_t>();
    const auto name = fields.number<std::uint16_t>();
    const auto extra = fields.number<std::uint16_t>();
    const auto comment = fields.number<std::uint16_t>();
    fields.take(8);
    entry.offset = fields.number<std::uint32_t>();
    require((flags & 1U) == 0U, Exit::kData, file.name(), ": is encrypted");
    entry.name = file.take(name);
    read_zip64(file.take(extra), &entry, file.name());
    file.skip(comment);
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::string_view zip_content(ByteFile& file, const ZipEntry& entry, Decompressor* expand) {
  file.seek(entry.offset);
  const std::string head(file.take(30));
  require(head.starts_with("PK\x03\x04"), Exit::kData, file.name(), ": ", shown(entry.name),
          " is not where its directory says");
  Bytes fields(std::string_view(head).substr(26), file.name());
  const auto name = fields.number<std::uint16_t>();
  const auto extra = fields.number<std::uint16_t>();
  file.skip(std::uint64_t{name} + extra);
  require(entry.method == 0 || entry.method == 8, Exit::kData, file.name(), ": ", shown(entry.name),
          " is packed by method ", entry.method, ", which NumPy does not write");
  const std::string_view content =
      expand->expand(entry.method == 0 ? "" : "deflate", file.take(entry.packed), entry.size);
  require(crc32(content) == entry.crc, Exit::kData, file.name(), ": the checksum of ",
          shown(entry.name), " is wrong; the file is damaged");
  return content;
}

}  // namespace

void read_npy(const std::filesystem::path& path, const std::string& name, LogBuilder& builder) {
  ByteFile file(path);
  try {
    add_number_arrays({parse_npy("c", file.take(file.size()), file.name())}, name, builder);
  } catch (const NotNumbers& reason) {
    fail(Exit::kData, file.name(), ": ", reason.what());
  }
  builder.log().format = "NumPy array";
}

namespace {

/// Spreadsheets and other archives begin with the same bytes.
void require_arrays(const std::vector<ZipEntry>& entries, const std::string& file) {
  const auto has = [&](const auto& wanted) {
    return std::any_of(entries.begin(), entries.end(),
                       [&](const ZipEntry& entry) { return wanted(entry.name); });
  };
  require(!has([](const std::string& name) {
    return name.starts_with("xl/") || name == "content.xml";
  }),
          Exit::kData, file, ": is a spreadsheet; save the sheet as CSV");
  require(has([](const std::string& name) { return name.ends_with(".npy"); }), Exit::kData, file,
          ": is an archive without NumPy arrays; unpack it and name the files in it");
}

}  // namespace

void read_npz(const std::filesystem::path& path, LogBuilder& builder) {
  ByteFile file(path);
  Decompressor expand(file.name(), file.size());
  std::vector<NumberArray> arrays;
  const std::vector<ZipEntry> entries = zip_directory(file);
  require_arrays(entries, file.name());
  for (const ZipEntry& entry : entries) {
    if (!entry.name.ends_with(".npy")) continue;
    const std::string name = entry.name.substr(0, entry.name.size() - 4);
    const std::string_view content = zip_content(file, entry, &expand);
    try {
      arrays.push_back(parse_npy(name, content, file.name()));
    } catch (const NotNumbers& reason) {
      builder.log().notes.push_back(shown(name) + " " + reason.what() + ": left out");
    }
  }
  add_number_arrays(arrays, "", builder);
  builder.log().format = "NumPy arrays (npz)";
}

}  // namespace dcnn
