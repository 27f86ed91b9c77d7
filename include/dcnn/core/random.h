// SPDX-License-Identifier: Apache-2.0
// Random numbers that are the same on every platform and for every number of threads.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace dcnn {

/// xoshiro256++ (Blackman and Vigna 2019) seeded by splitmix64; normals by Box and Muller (1958).
/// Work that is split over threads or resumed takes a stream per piece: Rng({seed, epoch, step}).
class Rng {
 public:
  explicit Rng(std::uint64_t seed) : Rng({seed}) {}
  /// The stream named by a list of numbers; different lists give independent streams.
  Rng(std::initializer_list<std::uint64_t> key);

  std::uint64_t bits();
  /// Uniform in [0, 1).
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in {0, …, n-1}.
  std::uint64_t below(std::uint64_t n);
  /// Standard normal.
  double normal();

 private:
  std::uint64_t state_[4];
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// One step of splitmix64: a 64-bit mix in which every input bit reaches every output bit.
inline std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// 0 … n-1 in random order (Fisher and Yates).
std::vector<std::int64_t> permutation(std::int64_t n, Rng& rng);

}  // namespace dcnn
