// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/random.h"

#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/elementary.h"

namespace dcnn {

Rng::Rng(std::initializer_list<std::uint64_t> key) {
  std::uint64_t hash = 0;
  for (const auto word : key) hash = mix_bits(hash ^ mix_bits(word));
  for (auto& word : state_) word = hash = mix_bits(hash);
}

std::uint64_t Rng::bits() {
  const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double Rng::uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

std::uint64_t Rng::below(std::uint64_t n) {
  const std::uint64_t reject_below =
      (0 - n) % n;  // 2^64 mod n: without it small numbers come oftener
  for (;;) {
    const std::uint64_t draw = bits();
    if (draw >= reject_below) return draw % n;
  }
}

double Rng::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * elementary::log(1.0 - uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_ = radius * elementary::sin(angle);
  has_spare_ = true;
  return radius * elementary::cos(angle);
}

std::vector<std::int64_t> permutation(std::int64_t n, Rng& rng) {
  std::vector<std::int64_t> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), std::int64_t{0});
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng.below(i)]);
  return order;
}

}  // namespace dcnn
