#include "check/axes.h"

#include <algorithm>
#include <array>

namespace dcnn::check {
namespace {

using Eigen::Index;

std::vector<Eigen::Matrix3d> all_permutations() {
  std::vector<Eigen::Matrix3d> all;
  std::array<Index, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
      for (Index i = 0; i < 3; ++i) {
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

std::string axes_words(const Eigen::Matrix3d& P, const std::string& stem) {
  std::string words;
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j) {
      if (P(i, j) == 0.0) continue;
      words += std::string(i == 0 ? "" : ", ") + "xyz"[i] + " = " + (P(i, j) > 0 ? "" : "-") +
               stem + "xyz"[j];
    }
  }
  return words;
}

}  // namespace dcnn::check
