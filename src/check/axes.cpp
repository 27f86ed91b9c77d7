// SPDX-License-Identifier: Apache-2.0
#include "check/axes.h"

namespace dcnn::check {

std::string axes_words(const Eigen::Matrix3d& P, const std::string& stem) {
  std::string words;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      if (P(i, j) == 0.0) continue;
      words += std::string(i == 0 ? "" : ", ") + "xyz"[i] + " = " + (P(i, j) > 0 ? "" : "-") +
               stem + "xyz"[j];
    }
  }
  return words;
}

}  // namespace dcnn::check
