// SPDX-License-Identifier: Apache-2.0
// What a motion would show of a law that nobody has named.
#pragma once

#include "dcnn/physics/motion.h"

namespace dcnn::design {

/// Expected information, in nats for each of the 18 components of velocity, rate, both
/// accelerations, direction of gravity (in the sensor frame) and position, about a force that is
/// linear in them: ln|1 + n C|/(2·18), C their covariance, each in units of `largest`, n the
/// samples that are independent. The force is as large as the noise of one of these at that size.
double coverage(const Motion& motion, const Eigen::VectorXd& largest, double samples);

/// The components, (T, 18).
Eigen::MatrixXd states_of(const Motion& motion);

}  // namespace dcnn::design
