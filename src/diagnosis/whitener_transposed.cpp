// SPDX-License-Identifier: Apache-2.0
// The transpose of the whitening, which scores many columns at once.
#include "diagnosis/whitener.h"

namespace dcnn {

Signals Whitener::transposed(const Eigen::VectorXd& rows, const std::vector<Index>& sizes) const {
  Signals signals;
  for (const Index size : sizes) signals.emplace_back(Eigen::MatrixXd::Zero(size, channels_));
  Index row = 0;
  for (const Run& run : runs_) {
    Eigen::MatrixXd own = rows.segment(row, run.count * channels_).reshaped(run.count, channels_);
    if (decorrelate_.size() > 0) own = (own * decorrelate_).eval();
    for (Index j = 0; j < channels_; ++j) {
      const Filter& filter = filters_[static_cast<std::size_t>(j)];
      const Index longest = static_cast<Index>(filter.coefficients.size()) - 1;
      Eigen::VectorXd means = Eigen::VectorXd::Zero(run.count);
      for (Index b = 0; b < run.count; ++b, ++row) {
        const auto order = static_cast<std::size_t>(std::min(b, longest));
        const double x = own(b, j) * inverse_level_(row) / filter.deviation[order];
        means(b) += x;
        for (std::size_t i = 0; i < order; ++i) {
          means(b - 1 - static_cast<Index>(i)) -= filter.coefficients[order][i] * x;
        }
      }
      auto block = signals[run.log].col(j).segment(run.first, run.count * block_);
      for (Index k = 0; k < block.size(); ++k) {
        block(k) = means(k / block_) / static_cast<double>(block_);
      }
    }
  }
  return signals;
}

}  // namespace dcnn
