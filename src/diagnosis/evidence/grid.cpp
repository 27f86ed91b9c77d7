// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/grid.h"

#include <cmath>

namespace dcnn::evidence {
namespace {

constexpr Index kPool = 3;

}  // namespace

Grid::Grid(const Setting& setting)
    : whitener_(setting.whitener.at_stride(setting.whitener.block())),
      study_(thinned(setting.study, setting.whitener.block())),
      mask_(setting.mask),
      pool_(study_.is_static() ? 1 : kPool),  // poses at rest have nothing in common
      seconds_(static_cast<double>(pool_) * setting.whitener.block_seconds()) {
  const auto& info = setting.whitener.row_info();
  const double dt = setting.whitener.block_seconds();
  pool_of_.assign(info.size(), -1);
  double last_end = -1e300;
  for (std::size_t begin = 0; begin + pool_ <= info.size();) {
    const auto &first = info[begin], &last = info[begin + pool_ - 1];
    const bool run = first.log == last.log && first.channel == last.channel &&
                     last.t - first.t <= (static_cast<double>(pool_) - 0.5) * dt;
    const bool whole =
        run && mask_.segment(static_cast<Index>(begin), static_cast<Index>(pool_)).minCoeff() > 0.0;
    if (whole) {
      for (std::size_t k = 0; k < pool_; ++k) pool_of_[begin + k] = rows_;
      const bool follows = !runs_.empty() && runs_.back().log == first.log &&
                           runs_.back().channel == first.channel &&
                           std::abs(first.t - last_end) < 0.5 * seconds_;
      if (!follows) runs_.push_back({first.log, first.channel, rows_, 0});
      ++runs_.back().count;
      last_end = first.t + seconds_;
      ++rows_;
    }
    begin += run ? pool_ : 1;
  }
}

Eigen::VectorXd Grid::pooled(const Eigen::VectorXd& whitened) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(rows_);
  const double share = 1.0 / std::sqrt(static_cast<double>(pool_));
  for (std::size_t row = 0; row < pool_of_.size(); ++row) {
    if (pool_of_[row] >= 0) out(pool_of_[row]) += share * whitened(static_cast<Index>(row));
  }
  return out;
}

Eigen::MatrixXd Grid::pooled(const Eigen::MatrixXd& whitened) const {
  Eigen::MatrixXd out(rows_, whitened.cols());
  for (Index k = 0; k < whitened.cols(); ++k) {
    out.col(k) = pooled(Eigen::VectorXd(whitened.col(k)));
  }
  return out;
}

Eigen::VectorXd Grid::operator()(const Signals& signals) const {
  return pooled(whitener_(signals));
}

}  // namespace dcnn::evidence
