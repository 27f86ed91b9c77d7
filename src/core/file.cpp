// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <mutex>

#include "core/descriptor.h"
#include "core/replace.h"
#include "core/staging.h"
#include "dcnn/core/claims.h"
#include "dcnn/core/file_set.h"
#include "dcnn/core/ranks.h"
#include "dcnn/core/standard_input.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

bool is_stream(const fs::path& file) {
  struct stat info {};
  return ::stat(file.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

std::string all_of_standard_input(std::size_t max_bytes, Exit exit) {
  std::string bytes;
  char chunk[1 << 16];
  while (const std::size_t got = read_standard_input(bytes.size(), chunk, sizeof chunk, exit)) {
    require(bytes.size() + got <= max_bytes, exit, "standard input: larger than ", max_bytes,
            " bytes");
    bytes.append(chunk, got);
  }
  return bytes;
}

/// What has come to the name since it was claimed is kept, and so is what this command has made.
void keep_both(const fs::path& temporary, const fs::path& path) {
  constexpr int kMost = 100;
  for (int k = 2; k < kMost; ++k) {
    const fs::path beside = path.string() + "." + std::to_string(k);
    if (!rename_new(temporary, beside)) continue;
    fail(Exit::kFailure, path.string(),
         ": was made by somebody else meanwhile and is kept; this command's own is ",
         beside.string());
  }
}

void replace_file(const fs::path& path, std::string_view bytes) {
  constexpr int kTries = 10;
  fs::path temporary = temporary_name(path);
  bool written = false;
  for (int i = 0; i < kTries && !(written = write_aside(temporary, bytes, path)); ++i) {
    temporary = temporary_name(path);
  }
  check_call(written, Exit::kFailure, path, "cannot write");
  try {
    const bool is_new = must_be_new(path);
    bool renamed = is_new && rename_new(temporary, path);
    if (!renamed && is_new) {
      check_call(errno == EEXIST, Exit::kFailure, path, "cannot replace");
      if (must_be_new(path)) keep_both(temporary, path);  // else what came may be replaced
    }
    if (!renamed) renamed = ::rename(temporary.c_str(), path.c_str()) == 0;
    check_call(renamed, Exit::kFailure, path, "cannot replace");
    is_ours(path);
  } catch (const Error&) {
    ::unlink(temporary.c_str());
    throw;
  }
  sync_folder(folder_of(path));
}

}  // namespace

std::size_t read_standard_input(std::size_t offset, char* to, std::size_t size, Exit exit) {
  static std::mutex one_at_a_time;
  static std::string kept;
  const std::lock_guard lock(one_at_a_time);
  if (offset < kept.size()) return kept.copy(to, size, offset);
  const auto got = completed([&] { return ::read(STDIN_FILENO, to, size); });
  check_call(got >= 0, exit, "standard input", "cannot read");
  kept.append(to, static_cast<std::size_t>(got));
  return static_cast<std::size_t>(got);
}

std::string read_file(const fs::path& path, std::size_t max_bytes, Exit exit) {
  if (path == "-") return all_of_standard_input(max_bytes, exit);
  const fs::path from = put_aside_as(path).value_or(path);
  Descriptor fd(completed([&] { return ::open(from.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); }));
  check_call(fd.get() >= 0, exit, path, "cannot open");
  struct stat info {};
  const bool known = ::fstat(fd.get(), &info) == 0;
  check_call(known, exit, path, "cannot read");
  require(!S_ISDIR(info.st_mode), exit, path.string(), ": is a folder; name a file");
  require(S_ISREG(info.st_mode), exit, path.string(), ": is not a regular file");
  const auto size = static_cast<std::size_t>(info.st_size);
  require(size <= max_bytes, exit, path.string(), ": larger than ", max_bytes, " bytes");
  std::string bytes(size, '\0');
  const auto have = read_all(fd.get(), bytes.data(), size);
  check_call(have.has_value(), exit, path, "cannot read");
  bytes.resize(*have);
  return bytes;
}

void write_file(const fs::path& path, std::string_view bytes) {
  if (!is_first_rank()) return;
  const Target target = target_of(path);
  const auto put = [&](int stream) {
    const bool written = write_all(stream, bytes);
    check_call(written, Exit::kFailure, path, "cannot write");
  };
  if (target.descriptor >= 0) return put(target.descriptor);
  if (is_stream(target.file)) {
    Descriptor fd(completed([&] { return ::open(target.file.c_str(), O_WRONLY | O_CLOEXEC); }));
    check_call(fd.get() >= 0, Exit::kFailure, path, "cannot write");
    return put(fd.get());
  }
  make_folder(target.file.parent_path());
  if (!put_aside(target.file, bytes)) replace_file(target.file, bytes);
}

std::optional<fs::path> replaced_file(const fs::path& path) {
  const Target target = target_of(path);
  std::error_code missing;
  if (target.descriptor >= 0 || !fs::is_regular_file(target.file, missing)) return std::nullopt;
  return target.file;
}

namespace {

/// What can be known to fail later fails now; what ended processes left is finished or removed.
void prepare(const fs::path& folder) {
  expect_writable(folder);
  recover_file_sets(folder);
  sweep_temporaries(folder);
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder) {
  if (!is_first_rank()) return;
  made_ = missing_folders(folder);
  make_folder(folder);
  folder_ = completed([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  check_call(folder_ >= 0, Exit::kFailure, folder, "cannot open this folder");
  // A file system that cannot lock folders (NFS) is not refused.
  const bool locked = completed([&] { return ::flock(folder_, LOCK_EX | LOCK_NB); }) == 0;
  const bool held_by_another = !locked && errno == EWOULDBLOCK;
  try {
    if (!held_by_another) prepare(folder);
  } catch (const Error&) {
    ::close(folder_);
    throw;
  }
  if (!held_by_another) return;
  ::close(folder_);
  fail(Exit::kUsage, folder.string(),
       ": another process is writing here; wait for it or choose another --out");
}

FolderLock::~FolderLock() {
  if (folder_ < 0) return;
  for (const fs::path& made : made_) {
    if (::rmdir(made.c_str()) != 0) break;  // it holds something
  }
  ::close(folder_);
}

}  // namespace dcnn
