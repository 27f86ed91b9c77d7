// SPDX-License-Identifier: Apache-2.0
#include "dcnn/import/log.h"

#include <algorithm>
#include <cmath>

namespace dcnn {

void SizeCount::add(double value) {
  const double size = std::abs(value);
  const int power = size > 0.0 ? std::clamp(std::ilogb(size), kLeast, kMost) : kLeast;
  const auto at = static_cast<std::size_t>(power - kLeast);
  largest_[at] = std::max(largest_[at], size);
  ++count_[at];
  ++all_;
}

double SizeCount::usual() const {
  constexpr double kLargest = 0.01;
  double above = 0.0;
  for (std::size_t k = count_.size(); k-- > 0;) {
    above += static_cast<double>(count_[k]);
    if (above > kLargest * static_cast<double>(all_)) return largest_[k];
  }
  return 0.0;
}

void LogChannel::add(double value, bool keep) {
  if (keep) values.push_back(value);
  if (!std::isfinite(value)) return;
  if (finite > 0) largest_step = std::max(largest_step, std::abs(value - last));
  last = value;
  ++finite;
  low = std::min(low, value);
  high = std::max(high, value);
  sizes.add(value);
  whole = whole && value == std::floor(value);
}

Index LogStream::find(const std::string& channel) const {
  for (std::size_t k = 0; k < channels.size(); ++k) {
    if (channels[k].name == channel) return static_cast<Index>(k);
  }
  return -1;
}

}  // namespace dcnn
