// SPDX-License-Identifier: Apache-2.0
// The lattice that logged values lie on.
#pragma once

#include <Eigen/Dense>

namespace dcnn {

/// The least step between different values, in their unit; 0 for a constant.
double resolution(const Eigen::VectorXd& values);

}  // namespace dcnn
