// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/line_filter.h"

namespace dcnn {

LineFilter::LineFilter(Index length, Index columns)
    : length_(length),
      past_(length, columns),
      sum_(Eigen::RowVectorXd::Zero(columns)),
      moment_(Eigen::RowVectorXd::Zero(columns)) {
  past_.setZero();
}

void LineFilter::restart(const Eigen::RowVectorXd& first) {
  const auto n = static_cast<double>(length_);
  past_.rowwise() = first;
  oldest_ = 0;
  sum_ = n * first;
  moment_ = 0.5 * n * (n - 1.0) * first;
}

void LineFilter::push(const Eigen::RowVectorXd& row, Eigen::RowVectorXd& value) {
  const auto n = static_cast<double>(length_);
  moment_ += sum_ - n * past_.row(oldest_);  // every row grows older by one, the oldest leaves
  sum_ += row - past_.row(oldest_);
  past_.row(oldest_) = row;
  oldest_ = (oldest_ + 1) % length_;
  value = (2.0 * (2.0 * n - 1.0) * sum_ - 6.0 * moment_) / (n * (n + 1.0));
}

Eigen::MatrixXd line_filtered(const Eigen::MatrixXd& x, const std::vector<Index>& segment_begin,
                              Index length) {
  Eigen::MatrixXd result(x.rows(), x.cols());
  LineFilter filter(length, x.cols());
  Eigen::RowVectorXd row, value;
  for (Index i = 0; i < x.rows(); ++i) {
    row = x.row(i);
    if (segment_begin[static_cast<std::size_t>(i)] == i) filter.restart(row);
    filter.push(row, value);
    result.row(i) = value;
  }
  return result;
}

}  // namespace dcnn
