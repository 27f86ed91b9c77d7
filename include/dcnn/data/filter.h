// SPDX-License-Identifier: Apache-2.0
// The zero-phase low-pass that measured, simulated and base columns share.
#pragma once

#include <Eigen/Dense>

#include "dcnn/data/recording.h"

namespace dcnn {

/// Butterworth of order 4 forward and backward over each column (T, columns), segment by segment,
/// with odd padding. hz = 0 or a static list: unchanged. hz at or above half the rate is an
/// Error(kData).
Eigen::MatrixXd low_pass(const Eigen::MatrixXd& signals, const Recording& recording, double hz);
/// The same on segments of samples `dt` apart; hz must be below half the rate.
Eigen::MatrixXd low_pass(const Eigen::MatrixXd& signals, const std::vector<Segment>& segments,
                         double dt, double hz);

}  // namespace dcnn
