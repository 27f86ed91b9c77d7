// SPDX-License-Identifier: Apache-2.0
// White noise on the pose BEFORE it is differentiated: what an encoder or a tracker would add.
#pragma once

#include <Eigen/Dense>
#include <cstdint>

#include "dcnn/data/features.h"

namespace dcnn {

/// Standard deviation of x, y, z, alpha, beta, gamma over the rows of the recordings (m, rad); 0
/// for a position that is not logged.
Eigen::VectorXd pose_deviation(const std::vector<Recording>& recordings);

/// (T, 6) white noise on x, y, z and the Euler angles at 0 dB: each coordinate has the variance it
/// had in training. The draw of a row depends on (key, row) alone. A system without a pose is
/// Error(kUsage), a model file that does not hold the variances Error(kModel).
Eigen::MatrixXd pose_draw(const Recording& recording, const FeatureLayout& layout,
                          std::uint64_t key);

/// (T, F) what pose_draw() is in the features of the set `pose`: estimators of derivatives are
/// linear, so at a level the features are x + 10^(-snr/20)·pose_noise(). Rates that the log itself
/// holds carry none. Another feature set is Error(kUsage).
Eigen::MatrixXd pose_noise(const Recording& recording, const FeatureLayout& layout,
                           std::uint64_t key);

/// The recording with `scale`·pose_draw() on its pose, for features that are not linear in it.
Recording with_pose_noise(Recording recording, const FeatureLayout& layout, double scale,
                          std::uint64_t key);

}  // namespace dcnn
