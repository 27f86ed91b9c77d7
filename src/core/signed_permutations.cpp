// SPDX-License-Identifier: Apache-2.0
#include "core/signed_permutations.h"

#include <algorithm>
#include <array>

namespace dcnn {
namespace {

std::vector<Eigen::Matrix3d> all_permutations() {
  std::vector<Eigen::Matrix3d> all;
  std::array<Eigen::Index, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
      for (Eigen::Index i = 0; i < 3; ++i) {
        P(i, order[static_cast<std::size_t>(i)]) = (signs >> i & 1) ? -1.0 : 1.0;
      }
      all.push_back(P);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

}  // namespace

const std::vector<Eigen::Matrix3d>& signed_permutations() {
  static const std::vector<Eigen::Matrix3d> all = all_permutations();
  return all;
}

}  // namespace dcnn
