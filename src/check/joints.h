// SPDX-License-Identifier: Apache-2.0
// Joints of which no links are described: their motion, what their torque may consist of, and what
// rates and torques say of the units of angle and clock.
#pragma once

#include <vector>

#include "check/reading.h"

namespace dcnn::check {

/// One joint's position, rate and acceleration on the sampled rows, SI.
struct JointMotion {
  Eigen::VectorXd place, v, a;
  Eigen::VectorXd dry;  ///< of dry friction: 1 forwards, -1 backwards
};
JointMotion joint_motion(const Log& log, const Sampled& rows, const Reading& reading,
                         const Joint& joint);
/// The same with dry friction that turns over `share` of the rms speed in every row of the log,
/// then smoothed as the torque is: friction of a smoothed velocity turns too slowly.
Eigen::VectorXd smoothed_dry(const Log& log, const Sampled& rows, const Joint& joint, double share);

/// How a joint's torque may depend on its angle.
enum class Place {
  kGravity,  ///< sine and cosine of the own and the other joints' angles
  kLinear,   ///< a spring
  kSlow      ///< a polynomial of the third degree
};

/// Appends a column, of unit length.
void append(Eigen::MatrixXd& A, const Eigen::VectorXd& column);

/// The torque's columns, of unit length: own inertia and dry friction; then what may have either
/// sign: the rate, which viscous friction opposes and a controller's damping as well while another
/// joint drives this one; a constant, the dependence on the angle, and what other joints transmit,
/// the nearest first, as far as there are ten rows to a column.
Eigen::MatrixXd torque_columns(const std::vector<JointMotion>& motions, std::size_t own,
                               Place place);

/// Joints with a position that moves and a torque.
std::vector<const Joint*> driven_joints(const Log& log);

/// Log likelihood of the logged rates beside the derivatives of the positions, under a reading's
/// units: each rate, or all of them, may be in a wrong unit by itself.
double rates_weight(const Log& log, const Sampled& rows, const Reading& reading);

/// Log density of the angles' sizes and of the torques that depend on them, where no arm is
/// described. Joints are a limb's, whose angles are within its limits and whose torque carries a
/// weight by their sine and cosine; or drives, which turn as often as they like.
double angles_weight(const Log& log, const Sampled& rows, const Reading& reading);

}  // namespace dcnn::check
