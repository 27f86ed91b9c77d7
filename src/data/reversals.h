// SPDX-License-Identifier: Apache-2.0
// How often a signal turns back.
#pragma once

#include <Eigen/Dense>

namespace dcnn {

/// Changes of direction of a signal (not empty) that has moved by more than `part` of its range
/// since the last; less is noise.
int reversals(const Eigen::VectorXd& x, double part);

}  // namespace dcnn
