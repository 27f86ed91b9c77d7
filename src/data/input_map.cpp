// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/input_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/lists.h"

namespace dcnn {
namespace {

constexpr double kConstant = 1e-12;  // a deviation below this is no scale

/// The five columns of Eq. 7 for one feature.
template <class Write>
inline void write_row(double x, double mean, double inverse_scale, const Write& write) {
  const double centred = x - mean;
  write(0, x);
  write(1, centred);
  write(2, centred * inverse_scale);
  write(3, std::abs(x));
  write(4, x * x);
}

Eigen::VectorXd vector_of(Options& options, const std::string& key, Index size) {
  const auto numbers = options.get<std::vector<double>>(key);
  if (size >= 0 && static_cast<Index>(numbers.size()) != size) {
    options.reject(key, "must hold ", size, " numbers");
  }
  const Eigen::VectorXd vector =
      Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Index>(numbers.size()));
  if (!vector.allFinite()) options.reject(key, "must be finite");
  return vector;
}

/// Deviations, none below the given share of the largest among features of the same unit.
Eigen::VectorXd floored(const Eigen::VectorXd& deviation, double share,
                        const std::vector<std::string>& units) {
  Eigen::VectorXd scale = deviation;
  for (std::size_t j = 0; j < units.size(); ++j) {
    for (std::size_t k = 0; k < units.size(); ++k) {
      if (units[j].empty() || units[j] != units[k]) continue;
      double& own = scale[static_cast<Index>(j)];
      own = std::max(own, share * deviation[static_cast<Index>(k)]);
    }
  }
  return scale;
}

}  // namespace

InputMap::Spec parse_input_map(Options options) {
  InputMap::Spec spec;
  spec.variance = options.choice("sigma", "std", {"std", "variance"}) == "variance";
  spec.zerocenter = options.get("zerocenter", true);
  spec.sigma_floor = options.number("sigma_floor", 0.0, 0.0, 1.0);
  spec.clip = options.number("clip", 0.0, 0.0, 1e6);
  options.finish();
  return spec;
}

InputMap::InputMap(const Eigen::MatrixXd& training, Spec spec,
                   const std::vector<std::string>& units)
    : spec_(spec) {
  assert(training.rows() > 0);
  const auto rows = static_cast<double>(training.rows());
  mean_ = training.colwise().mean().transpose();
  mean_square_ = training.colwise().squaredNorm().transpose() / rows;
  deviation_ = Eigen::VectorXd::Zero(training.cols());
  if (training.rows() > 1) {
    const Eigen::MatrixXd centred = training.rowwise() - mean_.transpose();
    deviation_ = (centred.colwise().squaredNorm().transpose() / (rows - 1.0)).cwiseSqrt();
  }
  scale_ = floored(deviation_, spec.sigma_floor, units);
  derive();
  centre_ = Eigen::VectorXd::Zero(training.cols() * kColumns);
  if (!spec.zerocenter) return;
  for (Index j = 0; j < training.cols(); ++j) {
    double* sum = centre_.data() + j * kColumns;
    for (const double x : training.col(j)) {
      write_row(std::clamp(x, least_[j], most_[j]), mean_[j], inverse_scale_[j],
                [sum](Index k, double value) { sum[k] += value; });
    }
  }
  centre_ /= rows;
}

/// What follows from the stored numbers.
void InputMap::derive() {
  const bool variance = spec_.variance;
  inverse_scale_ = scale_.unaryExpr([variance](double sd) {
    if (sd < kConstant) return 1.0;
    return 1.0 / (variance ? sd * sd : sd);
  });
  const double width = spec_.clip > 0.0 ? spec_.clip : std::numeric_limits<double>::infinity();
  const Eigen::VectorXd reach =
      scale_.unaryExpr([](double sd) { return std::max(sd, kConstant); }) * width;
  least_ = mean_ - reach;
  most_ = mean_ + reach;
}

template <class Out>
void InputMap::write(const double* x, Out* map) const {
  for (Index j = 0; j < features(); ++j) {
    Out* row = map + j * kColumns;
    const double* centre = centre_.data() + j * kColumns;
    write_row(std::clamp(x[j], least_[j], most_[j]), mean_[j], inverse_scale_[j],
              [=](Index k, double value) { row[k] = static_cast<Out>(value - centre[k]); });
  }
}
template void InputMap::write<float>(const double*, float*) const;
template void InputMap::write<double>(const double*, double*) const;

Json InputMap::to_json() const {
  return {{"variance", spec_.variance},       {"zerocenter", spec_.zerocenter},
          {"sigma_floor", spec_.sigma_floor}, {"clip", spec_.clip},
          {"mean", json_list(mean_)},         {"deviation", json_list(deviation_)},
          {"scale", json_list(scale_)},       {"mean_square", json_list(mean_square_)},
          {"centre", json_list(centre_)}};
}

InputMap InputMap::parse(const Json& json, const std::string& where, Exit exit) {
  Options options(json, where, exit);
  InputMap map;
  map.spec_.variance = options.get("variance", false);
  map.spec_.zerocenter = options.get("zerocenter", true);
  map.spec_.sigma_floor = options.number("sigma_floor", 0.0, 0.0, 1.0);
  map.spec_.clip = options.number("clip", 0.0, 0.0, 1e9);
  map.mean_ = vector_of(options, "mean", -1);
  const Index features = map.mean_.size();
  map.deviation_ = vector_of(options, "deviation", features);
  map.scale_ = vector_of(options, "scale", features);
  if (features > 0 && map.deviation_.minCoeff() < 0.0) options.reject("deviation", "is negative");
  if (features > 0 && map.scale_.minCoeff() < 0.0) options.reject("scale", "is negative");
  map.mean_square_ = vector_of(options, "mean_square", features);
  map.centre_ = vector_of(options, "centre", features * kColumns);
  map.derive();
  options.finish();
  return map;
}

}  // namespace dcnn
