// SPDX-License-Identifier: Apache-2.0
// The ways of exchanging and turning three axes by right angles.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace dcnn {

/// All 48, by the order of axes and within it by signs; the first eight are diagonal.
const std::vector<Eigen::Matrix3d>& signed_permutations();

}  // namespace dcnn
