// SPDX-License-Identifier: Apache-2.0
// The base of a robot on a wall or a ceiling: where its gravity points.
#pragma once

#include <optional>
#include <vector>

#include "identification/wrist_log.h"

namespace dcnn::identification {

/// The turn Q of the base's frame after which gravity points along -z, where the forces show that
/// it does not before: with the nominal mounting and a weight of any direction in the base they are
/// explained, with gravity along -z and any mounting they are not. Null for an upright base.
std::optional<Eigen::Matrix3d> upright_turn(const std::vector<WristLog>& logs,
                                            const Eigen::Matrix3d& R_ES);

/// Turns the base's frame: positions, rates and orientations as a base Q' of the old one sees them.
void turn_base(const Eigen::Matrix3d& Q, WristLog& log);

}  // namespace dcnn::identification
