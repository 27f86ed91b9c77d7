// SPDX-License-Identifier: Apache-2.0
// Numbers in bytes that we do not trust: nothing is read beyond their end.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dcnn/core/error.h"

namespace dcnn {

/// Walks over a piece of memory; `place` names it in errors and must outlive this.
class Bytes {
 public:
  Bytes(std::string_view bytes, const std::string& place) : bytes_(bytes), place_(&place) {}

  std::size_t left() const { return bytes_.size() - at_; }
  std::size_t at() const { return at_; }
  bool ended() const { return at_ == bytes_.size(); }
  void set_big_endian(bool big) { swap_ = big != (std::endian::native == std::endian::big); }

  std::string_view take(std::uint64_t count) {
    if (count > left()) {
      fail(Exit::kData, *place_, ": ends in the middle (", count, " bytes wanted, ", left(),
           " left); the log is cut off or damaged");
    }
    const std::string_view part = bytes_.substr(at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return part;
  }

  template <class T>
  T number() {
    std::uint8_t raw[sizeof(T)];
    std::memcpy(raw, take(sizeof(T)).data(), sizeof(T));
    if (swap_) {
      for (std::size_t k = 0; k < sizeof(T) / 2; ++k) std::swap(raw[k], raw[sizeof(T) - 1 - k]);
    }
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

  /// With its length before it.
  std::string_view text32() { return take(number<std::uint32_t>()); }

  const std::string& place() const { return *place_; }

 private:
  std::string_view bytes_;
  const std::string* place_;
  std::size_t at_ = 0;
  bool swap_ = std::endian::native == std::endian::big;
};

/// A regular file, read in order; memory is that of the largest piece taken.
class ByteFile {
 public:
  explicit ByteFile(const std::filesystem::path& path);
  ~ByteFile();
  ByteFile(const ByteFile&) = delete;
  ByteFile& operator=(const ByteFile&) = delete;

  std::uint64_t size() const { return size_; }
  std::uint64_t at() const { return at_; }
  std::uint64_t left() const { return size_ - at_; }
  /// Valid until the next call.
  std::string_view take(std::uint64_t count);
  void skip(std::uint64_t count);
  void seek(std::uint64_t at);
  const std::string& name() const { return name_; }

 private:
  [[noreturn]] void fail_short(std::uint64_t count) const;

  std::string name_;
  int fd_ = -1;
  std::uint64_t size_ = 0, at_ = 0;
  std::vector<char> buffer_;
  std::uint64_t begin_ = 0, end_ = 0;  // of the file's bytes in buffer_
};

/// Of zlib and MCAP (reversed 0x04C11DB7).
std::uint32_t crc32(std::string_view bytes);

}  // namespace dcnn
