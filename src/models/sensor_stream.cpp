// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "dcnn/data/line_filter.h"
#include "models/sensor_columns.h"

namespace dcnn {

/// SensorColumns row by row.
class SensorColumns::Streaming final : public StreamingInput {
 public:
  explicit Streaming(const SensorColumns& columns)
      : c_(columns),
        x_(columns.features_),
        line_(columns.features_),
        lines_(static_cast<Index>(columns.lengths_.size()), columns.features_),
        level_(columns.mixture_.noise_level()),
        cells_(columns.columns() * columns.features_) {
    for (const Index length : c_.lengths_) filters_.emplace_back(length, c_.features_);
  }

  void reset() noexcept override { fresh_ = true; }

  const Real* push(const Eigen::VectorXd& x) noexcept override {
    x_ = x.transpose();
    if (c_.is_lines()) {
      put_lines();
    } else {
      c_.frame_.turn(x_);
      put_body();
    }
    return cells_.data();
  }

 private:
  void put_body() {
    for (Index j = 0; j < x_.size(); ++j) {
      const double x = x_[j], centred = x - c_.channel_mean_[j], knee = c_.knee_[j];
      put(j, 0, x);
      put(j, 1, centred);
      put(j, 2, centred / knee * kKnee);
      put(j, 3, std::tanh(x / knee));
      put(j, 4, x * x);
    }
  }

  void put_lines() {
    for (std::size_t k = 0; k < filters_.size(); ++k) {
      if (fresh_) filters_[k].restart(x_);
      filters_[k].push(x_, line_);
      lines_.row(static_cast<Index>(k)) = line_;
      c_.frame_.turn(line_);
      put_column(static_cast<Index>(k));
      if (!c_.adaptive_ && k == kSaturatedLine) put_saturated();
    }
    if (c_.adaptive_) {
      if (fresh_) level_.restart();
      c_.mixture_.mix(lines_, level_.push(x_), line_);
      c_.frame_.turn(line_);
      put_column(c_.saturated_column() - 1);
      put_saturated();
    }
    fresh_ = false;
  }

  void put_column(Index column) {
    for (Index j = 0; j < line_.size(); ++j) put(j, column, line_[j]);
  }

  void put_saturated() {
    for (Index j = 0; j < line_.size(); ++j) {
      put(j, c_.saturated_column(), std::tanh(line_[j] / c_.knee_[j]));
    }
  }

  void put(Index channel, Index column, double value) {
    const Index i = channel * c_.columns() + column;
    const double standard = (value - c_.mean_[i]) / c_.deviation_[i];
    cells_[i] = static_cast<Real>(std::min(std::max(standard, -kClip), kClip));
  }

  SensorColumns c_;
  Eigen::RowVectorXd x_, line_;
  Eigen::MatrixXd lines_;  // (windows, F) before the turn
  NoiseLevel level_;
  std::vector<LineFilter> filters_;
  Eigen::Matrix<Real, Eigen::Dynamic, 1> cells_;
  bool fresh_ = true;
};

std::unique_ptr<StreamingInput> SensorColumns::streaming(const InputMap& /*map*/) const {
  return std::make_unique<Streaming>(*this);
}

}  // namespace dcnn
