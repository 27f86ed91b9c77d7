// SPDX-License-Identifier: Apache-2.0
#include "import/mat_tags.h"

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

}  // namespace

MatOutline outline_of_mat(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, kMatHeaderBytes> header{};
  MatOutline outline;
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
