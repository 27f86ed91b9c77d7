// SPDX-License-Identifier: Apache-2.0
// What is known of a tool before its recordings.
#pragma once

#include "identification/wrist_model.h"

namespace dcnn::identification {

/// The deviation of every parameter about zero: no tool is heavier than a tonne, and no part of it
/// farther from the flange than half a metre; a turn by more than half a revolution is none.
Eigen::VectorXd prior_deviation(const Layout& layout, double mass);

}  // namespace dcnn::identification
