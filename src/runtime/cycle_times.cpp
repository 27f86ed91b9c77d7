// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "dcnn/runtime/serve.h"

namespace dcnn {
namespace {

constexpr double kLeast = 1e-8, kRatio = 1.02;  // s

}  // namespace

void CycleTimes::add(double seconds) noexcept {
  const double place = std::log(std::max(seconds, kLeast) / kLeast) / std::log(kRatio);
  ++bins_[static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(kBins - 1)))];
  ++count_;
  most_ = std::max(most_, seconds);
}

double CycleTimes::quantile(double q) const noexcept {
  const double wanted = q * static_cast<double>(count_);
  std::uint64_t below = 0;
  for (int i = 0; i < kBins && count_ > 0; ++i) {
    below += bins_[static_cast<std::size_t>(i)];
    if (static_cast<double>(below) >= wanted) {
      return std::min(most_, kLeast * std::pow(kRatio, i + 1));
    }
  }
  return most_;
}

Json CycleTimes::to_json() const {
  return {{"cycles", count_},
          {"p50_s", quantile(0.5)},
          {"p99_s", quantile(0.99)},
          {"p999_s", quantile(0.999)},
          {"max_s", most_}};
}

}  // namespace dcnn
