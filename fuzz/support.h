// SPDX-License-Identifier: Apache-2.0
// What every fuzz target shares: foreign bytes are read, or refused by an Error of one line;
// nothing else comes out.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "dcnn/core/error.h"

namespace dcnn::fuzz {

/// Bytes as a regular file without a place on the disk.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    while (!bytes.empty()) {
      const auto written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written <= 0) std::abort();
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// A fault that no sanitizer sees.
inline void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fault: %s\n", what);
  std::abort();
}

/// Bytes as a file with a name of this process, gone when it ends.
class NamedFile {
 public:
  explicit NamedFile(const std::filesystem::path& folder, const std::string& ending = "")
      : path_(folder / ("dcnn-fuzz-" + std::to_string(::getpid()) + ending)),
        descriptor_(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {}
  NamedFile(const std::filesystem::path& folder, const std::string& ending, std::string_view bytes)
      : NamedFile(folder, ending) {
    write(bytes);
  }
  ~NamedFile() {
    ::close(descriptor_);
    ::unlink(path_.c_str());
  }
  NamedFile(const NamedFile&) = delete;
  NamedFile& operator=(const NamedFile&) = delete;

  void write(std::string_view bytes) const {
    demand(::ftruncate(descriptor_, 0) == 0 &&
               ::pwrite(descriptor_, bytes.data(), bytes.size(), 0) == ssize_t(bytes.size()),
           "no room for a file");
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int descriptor_;
};

/// Runs what reads; any exception but an Error of the user's is a fault.
template <class Read>
void attempt(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    demand(error.exit() != Exit::kFailure, error.what());
  }
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace dcnn::fuzz
