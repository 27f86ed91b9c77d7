// SPDX-License-Identifier: Apache-2.0
// Numbers of effects that stand at a bound of their range.
#pragma once

#include "diagnosis/joint_fit.h"

namespace dcnn::evidence {

/// A shape at a bound that the recordings would pass, or a strength of friction at zero, does not
/// move: beyond is another law or none. Gives its column of the tangent a precision that holds it,
/// and returns ln of the widths that the likelihood has on the other side, of half a normal
/// nearly 2/(s + sqrt(s^2 + 8 h/pi)), s the slope and h the curvature at the bound.
double hold_at_bounds(const JointFit& fit, Eigen::VectorXd& precision);

}  // namespace dcnn::evidence
