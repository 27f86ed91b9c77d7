// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/dyadic_sums.h"

#include <algorithm>
#include <bit>

namespace dcnn::frame_tcn {

DyadicSums::DyadicSums(Index columns, const std::vector<Index>& lags) {
  for (std::size_t level = 0; level < lags.size(); ++level) {
    // The level above asks for the sum before the newest one.
    const Index below = level + 1 < lags.size() ? Index{1} << level : 0;
    const Index oldest = std::max(lags[level], below);
    const auto length = std::bit_ceil(static_cast<std::uint64_t>(oldest + 1));
    rings_.push_back(Eigen::MatrixXd::Zero(columns, static_cast<Index>(length)));
  }
}

void DyadicSums::reset() noexcept {
  for (auto& ring : rings_) ring.setZero();
}

void DyadicSums::push(const Eigen::VectorXd& row) noexcept {
  ++count_;
  rings_[0].col(place(0, 0)) = row;
  for (std::size_t level = 1; level < rings_.size(); ++level) {
    rings_[level].col(place(level, 0)) = at(level - 1, 0) + at(level - 1, Index{1} << (level - 1));
  }
}

}  // namespace dcnn::frame_tcn
