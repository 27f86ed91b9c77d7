// SPDX-License-Identifier: Apache-2.0
// The checksum against its definition, bit by bit.
#include <gtest/gtest.h>

#include "import/bytes.h"

namespace dcnn {
namespace {

std::uint32_t crc_by_bits(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int k = 0; k < 8; ++k) crc = (crc & 1U) != 0U ? 0xEDB88320U ^ (crc >> 1) : crc >> 1;
  }
  return crc ^ 0xFFFFFFFFU;
}

TEST(Crc32, OfTheCatalogueEntry) { EXPECT_EQ(crc32("123456789"), 0xCBF43926U); }

TEST(Crc32, IsThatOfEveryLengthAndPlace) {
  std::string bytes;
  std::uint32_t state = 1;
  for (int k = 0; k < 1000; ++k) {
    state = 1664525U * state + 1013904223U;
    bytes += static_cast<char>(state >> 24);
  }
  for (std::size_t length = 0; length < 400; ++length) {
    const auto part = std::string_view(bytes).substr(length % 23, length);
    ASSERT_EQ(crc32(part), crc_by_bits(part)) << length;
  }
  EXPECT_EQ(crc32(bytes), crc_by_bits(bytes));
}

}  // namespace
}  // namespace dcnn
