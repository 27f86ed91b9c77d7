// SPDX-License-Identifier: Apache-2.0
// Files that are whole or not there at all.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dcnn/core/error.h"

namespace dcnn {

/// The bytes of a regular file of at most `max_bytes`, or of standard input for the path `-`;
/// anything else is an error with code `exit`.
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes, Exit exit);

/// Replaces `path` by `bytes` atomically: a temporary name beside it, fsync, rename, fsync of the
/// folder. After a crash at any moment the old file or the new one is there, never a part of
/// either. Links are followed: what they name is replaced. Streams (`-` for standard output,
/// /dev/stdout, a FIFO, a device) are written to. Of several ranks (core/ranks.h) the first writes.
/// Throws Error(kFailure) when the disk is full or the folder is not writable; parents are made.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// The existing regular file that write_file(path, …) would replace; none where nothing is or a
/// stream.
std::optional<std::filesystem::path> replaced_file(const std::filesystem::path& path);

/// A folder, made where there is none, that one process alone writes to: flock() on the folder
/// itself, so no file of it stays. Throws Error(kUsage) where another process holds it. A folder
/// that it made and nothing was written to goes with it.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept
      : folder_(std::exchange(other.folder_, -1)), made_(std::exchange(other.made_, {})) {}
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  int folder_ = -1;
  std::vector<std::filesystem::path> made_;  // the innermost first
};

}  // namespace dcnn
