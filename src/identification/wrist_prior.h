// SPDX-License-Identifier: Apache-2.0
// What is known of a tool before its recordings.
#pragma once

#include "identification/wrist_model.h"

namespace dcnn::identification {

/// The deviation of every parameter about zero: no tool is heavier than a tonne, and no part of it
/// farther from the flange than half a metre; a turn by more than half a revolution is none. A tilt
/// of the base is small, for it is a law that is linear in it, and so are shares of a sensor
/// matrix.
Eigen::VectorXd prior_deviation(const Layout& layout, const WristState& state);

}  // namespace dcnn::identification
