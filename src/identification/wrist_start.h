// SPDX-License-Identifier: Apache-2.0
// Where the fit begins: mounting and mass from the force alone.
#pragma once

#include "identification/wrist_model.h"

namespace dcnn::identification {

/// The rotation R_SE and mass with which m R_SE f explains the force best, each log with an offset of
/// its own (Kabsch 1976). Where gravity hardly turns in E, R_SE is that of `nominal`. Error(kData) for
/// forces that only left-handed axes, or the reaction, explain.
WristState starting_state(const std::vector<WristColumns>& columns,
                          const std::vector<WristLog>& logs, const Eigen::Matrix3d& nominal_R_SE,
                          bool mounting_known);

}  // namespace dcnn::identification
