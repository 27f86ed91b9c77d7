// SPDX-License-Identifier: Apache-2.0
// File descriptors: closed when they end, calls completed where a signal interrupts them.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <optional>
#include <string_view>

namespace dcnn {

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

/// A system call, again while a signal interrupts it.
template <class Call>
auto completed(const Call& call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

/// Whether all bytes are written; else errno says why not.
inline bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto written = completed([&] { return ::write(fd, bytes.data(), bytes.size()); });
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// How many bytes there were, `size` at most; nothing where reading fails (errno).
inline std::optional<std::size_t> read_all(int fd, char* to, std::size_t size) {
  std::size_t have = 0;
  while (have < size) {
    const auto got = completed([&] { return ::read(fd, to + have, size - have); });
    if (got < 0) return std::nullopt;
    if (got == 0) break;
    have += static_cast<std::size_t>(got);
  }
  return have;
}

}  // namespace dcnn
