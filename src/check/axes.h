// SPDX-License-Identifier: Apache-2.0
// Signed permutations in words.
#pragma once

#include <string>

#include "core/signed_permutations.h"

namespace dcnn::check {

/// "x = -fy, y = fx, z = fz", a row each, of the columns `stem`x, `stem`y and `stem`z.
std::string axes_words(const Eigen::Matrix3d& permutation, const std::string& stem);

}  // namespace dcnn::check
