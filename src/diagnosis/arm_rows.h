// SPDX-License-Identifier: Apache-2.0
// What an arm's joints recorded, as rows of one regression.
#pragma once

#include "diagnosis/load.h"

namespace dcnn {

/// Own terms of a joint that are fitted beside an arm's base: an offset, viscous friction, and
/// friction that turns within four widths of speed, of which the last is one that grows slower with
/// it; then those that only a given base is tested against.
constexpr Index kOwnFriction = 6;
constexpr Index kOwnOffset = 0, kOwnRate = 1;  ///< columns of the offset and of viscous friction
constexpr Index kOwnAliases =
    6;  ///< spring, drag, inertia, and the given torque, its rate, and its friction

/// Thinned rows of one joint, in the sense and unit of what was measured.
struct JointRows {
  Eigen::MatrixXd arm;     ///< (n, 10·joints) of every link's inertial parameters
  Eigen::MatrixXd own;     ///< (n, kOwnFriction), with a given base (n, kOwnFriction + kOwnAliases)
  Eigen::VectorXd target;  ///< measured less what is given
  std::vector<Index> piece;  ///< of time: a sixth of a recording, counted over all of them
};

/// Of the fitted recordings, less what is held out within them. Where all is given that the links
/// make, the joint's rests are left out, too, and rows weighed by their tails; else rests are
/// needed to tell weights from frictions. `bodies` (10·joints) or no rows: those of a description
/// with all bodies; columns `simulated` are taken off where the axis has one.
JointRows rows_of(const LoadedCase& loaded, const Eigen::VectorXd& bodies);

/// Divides each row by its likeliest deviation, where those of what all columns leave are
/// Student's: just after a rest or a turn friction is any force up to that which breaks loose, and
/// such rows would say of bodies what they do not know. Of fewer than two rows a column none tells.
void weigh_by_tails(JointRows& rows);

}  // namespace dcnn
