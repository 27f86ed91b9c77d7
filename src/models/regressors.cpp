// SPDX-License-Identifier: Apache-2.0
#include "models/regressors.h"

#include <algorithm>
#include <cmath>

namespace dcnn {
namespace {

Index place_of(const FeatureLayout& layout, const std::string& name) {
  const auto found = std::find(layout.names.begin(), layout.names.end(), name);
  return found == layout.names.end() ? -1 : found - layout.names.begin();
}

class AxisRegressors : public Regressors {
 public:
  AxisRegressors(const FeatureLayout& layout, Terms terms)
      : harmonics_(terms == Terms::kFourier ? 2 : 1) {
    for (const Axis& axis : layout.system.axes) {
      const Index column = place_of(layout, axis.name + "_position");
      if (column >= 0) positions_.push_back(column);
    }
    const auto features = static_cast<Index>(layout.names.size());
    for (Index j = 0; j < features && terms == Terms::kRigid; ++j) {
      const bool is_position =
          std::find(positions_.begin(), positions_.end(), j) != positions_.end();
      if (!is_position) others_.push_back(j);
    }
    const auto positions = static_cast<Index>(positions_.size());
    const Index terms_of_all = positions * (1 + 2 * harmonics_);
    // Axes may turn or slide, and signals be anything: every term is a kind of its own.
    for (Index k = 0; k < terms_of_all + static_cast<Index>(others_.size()) + 1; ++k) add_group(1);
  }

  void write(const Eigen::RowVectorXd& x, Eigen::RowVectorXd& terms) const override {
    Index k = 0;
    for (const Index column : positions_) {
      const double q = x[column];
      terms[k++] = q;
      for (Index harmonic = 1; harmonic <= harmonics_; ++harmonic) {
        terms[k++] = std::sin(static_cast<double>(harmonic) * q);
        terms[k++] = std::cos(static_cast<double>(harmonic) * q);
      }
    }
    for (const Index column : others_) terms[k++] = x[column];
    terms[k] = 1.0;
  }

 private:
  Index harmonics_;
  std::vector<Index> positions_, others_;
};

}  // namespace

Eigen::MatrixXd Regressors::of(const Eigen::MatrixXd& x) const {
  Eigen::MatrixXd terms(x.rows(), count());
  Eigen::RowVectorXd from(x.cols()), to(count());
  for (Index i = 0; i < x.rows(); ++i) {
    from = x.row(i);
    write(from, to);
    terms.row(i) = to;
  }
  return terms;
}

void Regressors::add_group(Index terms) {
  const Index kind = groups_.empty() ? 0 : groups_.back() + 1;
  groups_.insert(groups_.end(), static_cast<std::size_t>(terms), kind);
}

WristColumns wrist_columns(const FeatureLayout& layout) {
  const bool body = layout.spec.set == FeatureSpec::Set::kBody;
  return {.orientation = place_of(layout, body ? "ux" : "alpha"),
          .angular_velocity = place_of(layout, body ? "wx" : "dalpha"),
          .acceleration = place_of(layout, "ax"),
          .angular_acceleration = place_of(layout, body ? "dwx" : "ddalpha")};
}

std::shared_ptr<const Regressors> axis_regressors(const FeatureLayout& layout, Terms terms) {
  return std::make_shared<AxisRegressors>(layout, terms);
}

std::shared_ptr<const Regressors> make_regressors(const FeatureLayout& layout, Terms terms) {
  const bool axes = layout.spec.set == FeatureSpec::Set::kAxes;
  return axes ? axis_regressors(layout, terms) : wrist_regressors(layout, terms);
}

}  // namespace dcnn
