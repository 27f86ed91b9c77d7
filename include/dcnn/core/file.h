// Files that are whole or not there at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "dcnn/core/error.h"

namespace dcnn {

/// The bytes of a regular file of at most `max_bytes`; anything else is an error with code `exit`.
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes, Exit exit);

/// Replaces `path` by `bytes` atomically: a temporary name beside it, fsync, rename, fsync of the
/// folder. After a crash at any moment the old file or the new one is there, never a part of
/// either. Throws Error(kFailure) when the disk is full or the folder is not writable; parents are
/// made.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Appends one line and flushes it to the disk (metrics as JSON lines).
void append_line(const std::filesystem::path& path, std::string_view line);

}  // namespace dcnn
