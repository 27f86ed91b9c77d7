// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/noise.h"

#include <cmath>
#include <utility>

#include "core/elementary.h"
#include "dcnn/core/parallel.h"
#include "dcnn/core/random.h"

namespace dcnn {
namespace {

std::vector<SnrLevel> parse_levels(Options& options) {
  const Json list = options.raw("levels_db");
  if (list.is_null()) return NoiseSpec().levels;
  if (!list.is_array() || list.empty()) {
    options.reject("levels_db",
                   "must be a list of dB values, null for clean, such as [null, 40, 20]");
  }
  std::vector<SnrLevel> levels;
  for (const Json& level : list) {
    if (!level.is_null() && !level.is_number()) {
      options.reject("levels_db", "holds ", level.dump(), ", neither a number nor null");
    }
    levels.push_back(level.is_null() ? SnrLevel() : SnrLevel(level.get<double>()));
  }
  return levels;
}

}  // namespace

NoiseSpec parse_noise(Options options) {
  NoiseSpec spec;
  spec.levels = parse_levels(options);
  if (options.choice("scope", "feature", {"feature", "matrix"}) == "matrix") {
    spec.scope = NoiseSpec::Scope::kMatrix;
  }
  if (options.choice("power", "variance", {"variance", "meansquare"}) == "meansquare") {
    spec.power = NoiseSpec::Power::kMeanSquare;
  }
  const auto on = options.choice("on", "features", {"features", "pose", "both"});
  if (on == "pose") spec.on = NoiseSpec::Signal::kPose;
  if (on == "both") spec.on = NoiseSpec::Signal::kBoth;
  spec.block_rows = options.get<Index>("block_rows", 0);
  if (spec.block_rows < 0) options.reject("block_rows", "must not be negative");
  options.finish();
  return spec;
}

Eigen::VectorXd noise_deviation(const NoiseSpec& spec, const InputMap& training,
                                const Eigen::MatrixXd& x, SnrLevel snr) {
  if (!snr) return Eigen::VectorXd::Zero(training.features());
  Eigen::VectorXd power = spec.power == NoiseSpec::Power::kVariance
                              ? Eigen::VectorXd(training.deviation().array().square())
                              : Eigen::VectorXd(x.array().square().colwise().mean().transpose());
  if (spec.scope == NoiseSpec::Scope::kMatrix) power.setConstant(power.mean());
  return (power / elementary::pow(10.0, *snr / 10.0)).array().sqrt();
}

void add_noise(double* x, Index stride, const Eigen::VectorXd& deviation, std::uint64_t key,
               Index row) {
  Rng rng({key, static_cast<std::uint64_t>(row)});
  for (Index j = 0; j < deviation.size(); ++j) x[j * stride] += deviation[j] * rng.normal();
}

Eigen::MatrixXd with_noise(Eigen::MatrixXd x, const Eigen::VectorXd& deviation, std::uint64_t key) {
  if (deviation.isZero(0.0)) return x;
  const Index rows = x.rows(), pieces = piece_count(rows);
  for_each_piece(pieces, [&](Index k) {
    for (Index row = piece_begin(rows, pieces, k); row < piece_begin(rows, pieces, k + 1); ++row) {
      add_noise(x.data() + row, rows, deviation, key, row);
    }
  });
  return x;
}

}  // namespace dcnn
