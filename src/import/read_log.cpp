// SPDX-License-Identifier: Apache-2.0
// Which reader a file is for, by its first bytes.
#include <algorithm>
#include <fstream>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "dcnn/import/log.h"
#include "import/json_log.h"
#include "import/log_builder.h"
#include "import/mat_tags.h"
#include "import/readers.h"
#include "import/text_log.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;
constexpr const char* kPickle =
    "is a Python pickle, which runs code of its maker when it is read; save its arrays by "
    "numpy.savez or as CSV";

/// A FIFO or a device may be waited for without end.
constexpr const char* kNotRegular = ": is not a regular file; write it to one first";

/// The files of a folder that ros2 bag made; the path itself otherwise.
std::vector<fs::path> files_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::is_directory(status)) {
    require(path == "-" || !fs::exists(status) || fs::is_regular_file(status), Exit::kData,
            path.string(), kNotRegular);
    return {path};
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path, error)) {
    const std::string extension = entry.path().extension();
    if (extension != ".mcap" && extension != ".db3") continue;
    require(!entry.exists(error) || entry.is_regular_file(error), Exit::kData,
            entry.path().string(), kNotRegular);
    files.push_back(entry.path());
  }
  require(!files.empty(), Exit::kData, path.string(),
          ": is a folder without .mcap or .db3 files; name a file");
  std::sort(files.begin(), files.end());
  return files;
}

std::string first_bytes(const fs::path& path) {
  std::string bytes(64, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return bytes;
}

/// Files of others that people try, and what makes a log of them.
struct ForeignFormat {
  std::string_view magic;
  const char* words;
};
constexpr ForeignFormat kForeignFormats[] = {
    {"\x1F\x8B", "is compressed; unpack it: gunzip"},
    {"\x28\xB5\x2F\xFD", "is compressed; unpack it: unzstd"},
    {"\xD0\xCF\x11\xE0", "is a spreadsheet; save the sheet as CSV"},
    {"PAR1", "is a Parquet table; save it as CSV"},
    {"\x80\x02", kPickle},
    {"\x80\x03", kPickle},
    {"\x80\x04", kPickle},
    {"\x80\x05", kPickle},
    {"\x89HDF", "is an HDF5 file that MATLAB did not write; save its arrays as .npz or CSV"}};

void read_one(const fs::path& path, std::size_t number, LogBuilder& builder) {
  const std::string begin = path == "-" ? "" : first_bytes(path);
  const auto starts = [&](std::string_view magic) { return begin.starts_with(magic); };
  for (const ForeignFormat& format : kForeignFormats) {
    require(!starts(format.magic), Exit::kData, path.string(), ": ", format.words);
  }
  const std::string name = "file" + std::to_string(number);
  if (starts("\x89MCAP0\r\n")) return read_mcap(path, builder);
  if (starts("#ROSBAG V")) return read_bag(path, builder);
  if (starts("SQLite format 3")) return read_db3(path, builder);
  if (starts("\x93NUMPY")) return read_npy(path, name, builder);
  if (starts("PK\x03\x04")) return read_npz(path, builder);
  if (starts("MATLAB ") || is_mat4(begin)) return read_mat(path, builder);
  if (is_json(begin)) return read_json_log(path, builder);
  read_text_log(path, name, builder);
}

}  // namespace

ForeignLog read_log(const std::vector<fs::path>& paths, const ReadLogOptions& options) {
  ForeignLog log;
  log.command = options.command;
  LogBuilder builder(log, options);
  std::size_t number = 0;
  std::string formats;
  for (const fs::path& path : paths) {
    for (const fs::path& file : files_of(path)) {
      log.file = file.string();
      builder.begin_file(file.stem().string(), ++number);
      read_one(file, number, builder);
      if (formats.find(log.format) == std::string::npos) {
        formats += (formats.empty() ? "" : "; ") + log.format;
      }
    }
  }
  log.format = formats;
  const std::size_t given = options.text.columns.size(), taken = builder.columns_taken();
  require(taken == 0 || taken == given, Exit::kData, log.file, ": ", given,
          " names are given for the ", taken, " columns of ", number, " texts");
  if (paths.size() > 1) log.file = paths.front().string() + " and others";
  return log;
}

std::string known_formats() {
  return "text of any dialect, ROS 1 bags, rosbag2 (.mcap, .db3 or its folder), NumPy (.npy, "
         ".npz), "
         "MATLAB (.mat), JSON (one record a line, lists)";
}

}  // namespace dcnn
