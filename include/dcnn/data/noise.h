// SPDX-License-Identifier: Apache-2.0
// Gaussian noise on the feature vector, before Eq. 7 (spec section 4). Forces are never perturbed.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <optional>
#include <vector>

#include "dcnn/core/options.h"
#include "dcnn/data/input_map.h"

namespace dcnn {

/// A signal-to-noise ratio in dB; empty means clean.
using SnrLevel = std::optional<double>;

struct NoiseSpec {
  enum class Scope { kFeature, kMatrix };       ///< one power per feature, or one over all entries
  enum class Power { kVariance, kMeanSquare };  ///< of the training part, or of the array given
  /// The features, the pose they are derived from, or now one and now the other.
  enum class Signal { kFeatures, kPose, kBoth };
  std::vector<SnrLevel> levels{std::nullopt, 40.0, 30.0, 20.0, 10.0};
  Scope scope = Scope::kFeature;
  Power power = Power::kVariance;
  Signal on = Signal::kFeatures;
  /// Training noise: rows that share one level, counted from the beginning of each segment; 0 is
  /// one level for all rows of an epoch.
  Index block_rows = 0;
};

/// Keys: levels_db (numbers, null is clean), scope (feature|matrix), power
/// (variance|meansquare), on (features|pose|both), block_rows.
NoiseSpec parse_noise(Options options);

/// Standard deviation of the noise on each feature: sqrt(P_j / 10^(snr/10)); zeros when clean.
/// P_j comes from the training statistics, or with kMeanSquare from `x` (T, F) itself.
Eigen::VectorXd noise_deviation(const NoiseSpec& spec, const InputMap& training,
                                const Eigen::MatrixXd& x, SnrLevel snr);

/// Adds deviation_j·n to one feature vector; the draw depends on (key, row) alone, so neither order
/// nor threads matter. `x` holds deviation.size() values `stride` apart.
void add_noise(double* x, Index stride, const Eigen::VectorXd& deviation, std::uint64_t key,
               Index row);

/// x with noise on every row.
Eigen::MatrixXd with_noise(Eigen::MatrixXd x, const Eigen::VectorXd& deviation, std::uint64_t key);

}  // namespace dcnn
