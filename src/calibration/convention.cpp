// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/signed_permutations.h"
#include "dcnn/calibration/calibration.h"

namespace dcnn {
namespace {

/// "+y -x +z" of a signed permutation: row i says what to read as axis i.
std::string words_of(const Eigen::Matrix3d& Q) {
  std::string words;
  for (Index i = 0; i < 3; ++i) {
    Index k = 0;
    Q.row(i).cwiseAbs().maxCoeff(&k);
    words += std::string(i > 0 ? " " : "") + (Q(i, k) > 0 ? "+" : "-") + "xyz"[k];
  }
  return words;
}

}  // namespace

AxisConvention best_convention(const ForcePairs& pairs, const Eigen::Matrix3d& R_ES,
                               bool with_bias) {
  AxisConvention best;
  best.residual_rms = INFINITY;
  const double total = pairs.weights.sum();
  for (const Eigen::Matrix3d& Q : signed_permutations()) {
    if (Q.determinant() < 0.0) continue;  // left-handed
    for (const int sign : {1, -1}) {
      Eigen::MatrixXd left = pairs.reference - sign * pairs.sensor * (R_ES * Q).transpose();
      if (with_bias) left.rowwise() -= (pairs.weights.transpose() * left / total).eval();
      const double rms = std::sqrt(left.rowwise().squaredNorm().dot(pairs.weights) / (3.0 * total));
      if (rms < best.residual_rms) best = {words_of(Q), sign, rms};
    }
  }
  return best;
}

}  // namespace dcnn
