// SPDX-License-Identifier: Apache-2.0
#include "runtime/checks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

constexpr double kFarthest = 1e3;    // m, of a position
constexpr double kLargest = 1e5;     // N, N·m and rad
constexpr double kLatest = 1e12;     // s
constexpr double kNormError = 1e-3;  // of a quaternion, from rounding in a log

}  // namespace

void require_online(const Identifier& identifier, const std::string& where) {
  const FeatureLayout& layout = identifier.layout;
  require(layout.spec.set != FeatureSpec::Set::kAxes && layout.dt > 0.0, Exit::kModel, where,
          ": no model of a wrist tool in motion; train one on recordings of a pose");
  require(is_causal(layout.spec.derivative), Exit::kModel, where,
          ": its derivatives are not causal (they use later samples); train it with --online");
}

std::vector<Index> wrench_places(const Targets& targets, const std::string& where) {
  constexpr std::array<const char*, 6> kNames{"fx", "fy", "fz", "tx", "ty", "tz"};
  std::vector<Index> places;
  for (const std::string& name : targets.names) {
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    require(found != kNames.end(), Exit::kModel, where, ": predicts '", name,
            "', which is no part of a wrench; give a model of a wrist tool");
    places.push_back(found - kNames.begin());
  }
  std::vector<Index> sorted = places;
  std::sort(sorted.begin(), sorted.end());
  const bool whole =
      sorted == std::vector<Index>{0, 1, 2} || sorted == std::vector<Index>{0, 1, 2, 3, 4, 5};
  require(whole, Exit::kModel, where,
          ": must predict fx,fy,fz, with tx,ty,tz or without; train on recordings that have them");
  return places;
}

std::unique_ptr<Predictor> checked_predictor(const Identifier& identifier,
                                             const std::string& where) {
  constexpr Index kRows = 100;
  std::unique_ptr<Predictor> predictor = identifier.model->predictor();
  const InputMap& map = identifier.model->map();
  Rng rng({1, 20});
  Stream stream{Eigen::MatrixXd(kRows, map.features()), {{0, kRows}}};
  for (Index k = 0; k < kRows; ++k) {
    for (Index j = 0; j < map.features(); ++j) {
      stream.x(k, j) = map.mean()[j] + 0.5 * map.deviation()[j] * rng.normal();
    }
  }
  const Eigen::MatrixXd wanted = identifier.model->predict(stream);
  double error = 0.0;
  for (Index k = 0; k < kRows; ++k) {
    const Eigen::VectorXd& y = predictor->push(stream.x.row(k).transpose());
    error = std::max(error, (y - wanted.row(k).transpose()).cwiseAbs().maxCoeff());
  }
  const double size = wanted.cwiseAbs().maxCoeff();
  require(wanted.allFinite() && error <= 1e-3 * (1.0 + size), Exit::kModel, where,
          ": fails its self-test: sample by sample it differs by ", error,
          " from what it predicts for a recording; train again");
  predictor->reset();
  return predictor;
}

bool is_possible(const OnlineSample& sample) noexcept {
  const auto small = [](const auto& v, double limit) {
    return v.allFinite() && v.cwiseAbs().maxCoeff() <= limit;
  };
  const bool turn = sample.euler ? small(*sample.euler, kLargest)
                                 : small(sample.quaternion, 2.0) &&
                                       std::abs(sample.quaternion.norm() - 1.0) <= kNormError;
  return turn && std::abs(sample.t) <= kLatest && small(sample.position, kFarthest) &&
         small(sample.wrench, kLargest);
}

bool is_singular(const Eigen::Matrix3d& R_BE) noexcept {
  return 1.0 - R_BE(2, 0) * R_BE(2, 0) < 0.05 * 0.05;
}

}  // namespace dcnn
