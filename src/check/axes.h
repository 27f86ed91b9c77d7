// Signed permutations: the ways of exchanging and turning three axes by right angles.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

namespace dcnn::check {

/// All 48, by the order of axes and within it by signs; the first eight are diagonal.
const std::vector<Eigen::Matrix3d>& signed_permutations();

/// "x = -fy, y = fx, z = fz", a row each, of the columns `stem`x, `stem`y and `stem`z.
std::string axes_words(const Eigen::Matrix3d& permutation, const std::string& stem);

}  // namespace dcnn::check
