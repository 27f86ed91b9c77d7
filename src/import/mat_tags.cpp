// SPDX-License-Identifier: Apache-2.0
#include "import/mat_tags.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

namespace dcnn {
namespace {

constexpr std::uint64_t kMatHeaderBytes = 128, kTagBytes = 8;
constexpr std::size_t kVersionAt = 124;  // then "IM" (little-endian) or "MI"

std::uint32_t word_of(const unsigned char* bytes, bool little) {
  std::uint32_t value = 0;
  for (int k = 0; k < 4; ++k) value = value << 8U | bytes[little ? 3 - k : k];
  return value;
}

constexpr std::size_t kTag4Bytes = 20, kLongestName4 = 64;

/// The five words at the head of a variable of version 4.
struct Tag4 {
  std::uint32_t type, rows, columns, imaginary, name;
  bool is_valid() const {
    const std::uint32_t precision = type / 10 % 100;
    return type < 2000 && precision <= 5 && type % 10 <= 2 && imaginary <= 1 && name >= 2 &&
           name <= kLongestName4;
  }
  /// Of what follows the tag; a double, for the product may be beyond 64 bits.
  double bytes() const {
    constexpr double kSizes[] = {8.0, 4.0, 4.0, 2.0, 2.0, 1.0};
    return name + 1.0 * rows * columns * kSizes[type / 10 % 100] * (1 + imaginary);
  }
};
Tag4 tag4_of(std::string_view bytes) {
  const auto* b = reinterpret_cast<const unsigned char*>(bytes.data());
  const bool little = word_of(b, true) < 1000;
  return {word_of(b, little), word_of(b + 4, little), word_of(b + 8, little),
          word_of(b + 12, little), word_of(b + 16, little)};
}

MatOutline outline_of_mat4(std::ifstream& file, std::uint64_t size) {
  MatOutline outline;
  for (std::uint64_t at = 0; at < size;) {
    std::array<char, kTag4Bytes> bytes{};
    file.seekg(static_cast<std::streamoff>(at));
    outline.cut = !file.read(bytes.data(), bytes.size());
    if (outline.cut) break;
    const Tag4 tag = tag4_of({bytes.data(), bytes.size()});
    outline.cut = !tag.is_valid() || tag.bytes() > static_cast<double>(size - at - kTag4Bytes);
    if (outline.cut) break;
    at += kTag4Bytes + static_cast<std::uint64_t>(tag.bytes());
    ++outline.whole;
  }
  return outline;
}

}  // namespace

bool is_mat4(std::string_view first_bytes) {
  if (first_bytes.size() <= kTag4Bytes) return false;
  const Tag4 tag = tag4_of(first_bytes);
  if (!tag.is_valid()) return false;
  const std::string_view name = first_bytes.substr(kTag4Bytes, tag.name - 1);
  return std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

MatOutline outline_of_mat(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, kMatHeaderBytes> header{};
  MatOutline outline;
  file.read(header.data(), header.size());
  if (is_mat4({header.data(), static_cast<std::size_t>(file.gcount())})) {
    file.clear();
    return outline_of_mat4(file, std::filesystem::file_size(path));
  }
  file.clear();
  file.seekg(0);
  if (!file.read(header.data(), header.size())) {
    outline.cut = true;
    return outline;
  }
  const bool little = header[kVersionAt + 2] == 'I';
  if (header[kVersionAt + (little ? 1 : 0)] != 1) return outline;
  const std::uint64_t size = std::filesystem::file_size(path);
  for (std::uint64_t at = kMatHeaderBytes; at < size;) {
    std::array<char, kTagBytes> tag{};
    file.seekg(static_cast<std::streamoff>(at));
    outline.cut = !file.read(tag.data(), tag.size());
    if (outline.cut) break;
    std::array<unsigned char, kTagBytes> bytes{};
    std::memcpy(bytes.data(), tag.data(), tag.size());
    at += kTagBytes + word_of(bytes.data() + 4, little);
    outline.cut = at > size;
    if (!outline.cut) ++outline.whole;
  }
  return outline;
}

}  // namespace dcnn
