// SPDX-License-Identifier: Apache-2.0
// The checksum of zlib and MCAP, by a table or, where the processor has it, by carry-less products
// (Gopal et al., Fast CRC computation for generic polynomials using PCLMULQDQ, Intel 2009).
#include <array>

#include "import/bytes.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace dcnn {
namespace {

using CrcTable = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr CrcTable make_crc_table() {
  CrcTable table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int k = 0; k < 8; ++k) c = (c & 1U) != 0U ? 0xEDB88320U ^ (c >> 1) : c >> 1;
    table[0][n] = c;
  }
  for (std::size_t n = 0; n < 256; ++n) {
    for (std::size_t k = 1; k < 8; ++k) {
      table[k][n] = table[0][table[k - 1][n] & 0xFFU] ^ (table[k - 1][n] >> 8);
    }
  }
  return table;
}

/// Goes on from the state `crc`.
std::uint32_t crc_by_table(std::string_view bytes, std::uint32_t crc) {
  static constexpr CrcTable kTable = make_crc_table();
  std::size_t k = 0;
  if constexpr (std::endian::native == std::endian::little) {  // eight bytes a step
    for (; k + 8 <= bytes.size(); k += 8) {
      std::uint32_t low = 0, high = 0;
      std::memcpy(&low, bytes.data() + k, 4);
      std::memcpy(&high, bytes.data() + k + 4, 4);
      low ^= crc;
      crc = kTable[7][low & 0xFFU] ^ kTable[6][(low >> 8) & 0xFFU] ^
            kTable[5][(low >> 16) & 0xFFU] ^ kTable[4][low >> 24] ^ kTable[3][high & 0xFFU] ^
            kTable[2][(high >> 8) & 0xFFU] ^ kTable[1][(high >> 16) & 0xFFU] ^
            kTable[0][high >> 24];
    }
  }
  for (; k < bytes.size(); ++k) {
    crc = kTable[0][(crc ^ static_cast<std::uint8_t>(bytes[k])) & 0xFFU] ^ (crc >> 8);
  }
  return crc;
}

#if defined(__x86_64__)
using Lanes = __m128i;

constexpr std::size_t kLanesBytes = 16, kFewestBytes = 4 * kLanesBytes;

/// x^n mod P for the distances over which 128 bits are folded, bits reversed: low and high half.
struct Distance {
  std::uint64_t low, high;
};
constexpr Distance kOver512{0x154442bd4, 0x1c6e41596}, kOver128{0x1751997d0, 0x0ccaa009e};
constexpr std::uint64_t kOver64 = 0x163cd6124;
constexpr Distance kBarrett{0x1db710641, 0x1f7011641};  // P and x^64 / P

__attribute__((target("pclmul,sse4.1"))) Lanes folded(Lanes x, Lanes over, Lanes next) {
  return _mm_xor_si128(
      _mm_xor_si128(_mm_clmulepi64_si128(x, over, 0x00), _mm_clmulepi64_si128(x, over, 0x11)),
      next);
}

__attribute__((target("pclmul,sse4.1"))) Lanes lanes(const char* from) {
  Lanes x;
  std::memcpy(&x, from, sizeof x);
  return x;
}

__attribute__((target("pclmul,sse4.1"))) Lanes lanes(const Distance& d) {
  return _mm_set_epi64x(static_cast<long long>(d.high), static_cast<long long>(d.low));
}

/// Of whole lanes, four at least.
__attribute__((target("pclmul,sse4.1"))) std::uint32_t crc_by_products(std::string_view bytes,
                                                                       std::uint32_t crc) {
  const char* from = bytes.data();
  const char* const end = from + bytes.size();
  Lanes x[4];
  for (std::size_t k = 0; k < 4; ++k) x[k] = lanes(from + k * kLanesBytes);
  x[0] = _mm_xor_si128(x[0], _mm_cvtsi32_si128(static_cast<int>(crc)));
  const Lanes far = lanes(kOver512), near = lanes(kOver128);
  for (from += kFewestBytes; end - from >= static_cast<std::ptrdiff_t>(kFewestBytes);
       from += kFewestBytes) {
    for (std::size_t k = 0; k < 4; ++k) x[k] = folded(x[k], far, lanes(from + k * kLanesBytes));
  }
  Lanes sum = x[0];
  for (std::size_t k = 1; k < 4; ++k) sum = folded(sum, near, x[k]);
  for (; from < end; from += kLanesBytes) sum = folded(sum, near, lanes(from));
  // 128 bits to 64, these to 32 by Barrett's reduction.
  const Lanes low_words = _mm_setr_epi32(-1, 0, -1, 0);
  sum = _mm_xor_si128(_mm_clmulepi64_si128(sum, near, 0x10), _mm_srli_si128(sum, 8));
  sum = _mm_xor_si128(
      _mm_clmulepi64_si128(_mm_and_si128(sum, low_words), lanes(Distance{kOver64, 0}), 0x00),
      _mm_srli_si128(sum, 4));
  const Lanes barrett = lanes(kBarrett);
  Lanes quotient = _mm_clmulepi64_si128(_mm_and_si128(sum, low_words), barrett, 0x10);
  quotient = _mm_clmulepi64_si128(_mm_and_si128(quotient, low_words), barrett, 0x00);
  return static_cast<std::uint32_t>(_mm_extract_epi32(_mm_xor_si128(sum, quotient), 1));
}

bool has_products() {
  static const bool kHas = __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("sse4.1");
  return kHas;
}
#endif

}  // namespace

std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
#if defined(__x86_64__)
  const std::size_t whole = bytes.size() / kLanesBytes * kLanesBytes;
  if (whole >= kFewestBytes && has_products()) {
    crc = crc_by_products(bytes.substr(0, whole), crc);
    bytes.remove_prefix(whole);
  }
#endif
  return crc_by_table(bytes, crc) ^ 0xFFFFFFFFU;
}

}  // namespace dcnn
