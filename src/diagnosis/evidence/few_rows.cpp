// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/few_rows.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/linear_algebra.h"

namespace dcnn::evidence {
namespace {

/// ln Gamma(x): Stirling's series from 8 on, with a relative error below 1e-12.
double log_gamma(double x) {
  double shift = 0.0;
  for (; x < 8.0; ++x) shift += elementary::log(x);
  const double y = 1.0 / x, z = y * y;
  const double series =
      y * (1.0 / 12.0 - z * (1.0 / 360.0 - z * (1.0 / 1260.0 - z * (1.0 / 1680.0 - z / 1188.0))));
  constexpr double kHalfLogTwoPi = 0.91893853320467274;
  return (x - 0.5) * elementary::log(x) - x + kHalfLogTwoPi + series - shift;
}

}  // namespace

double log_student(double square, double freedom) {
  const double half = 0.5 * (std::max(0.0, freedom) + 1.0);
  return log_gamma(half) - half * elementary::log(0.5 * (std::max(0.0, square) + 1.0));
}

double freedom_of(const Linear& model, double rows) {
  Eigen::MatrixXd A = model.gram;
  A.diagonal() += model.precision;
  std::vector<Index> used;  // columns of zeros decide nothing
  for (Index k = 0; k < A.rows(); ++k) {
    if (A(k, k) > 0.0) used.push_back(k);
  }
  if (used.empty()) return rows;
  const Eigen::MatrixXd own = A(used, used), gram = model.gram(used, used);
  const Eigen::VectorXd scale = own.diagonal().cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd unit = scale.asDiagonal() * own * scale.asDiagonal();
  constexpr double kRidge = 1e-10;  // where columns hold each other
  unit.diagonal().array() += kRidge;
  const Eigen::MatrixXd half = inverse_cholesky(unit) * scale.asDiagonal();
  return rows - (half * gram * half.transpose()).trace();
}

double log_student_evidence(const Linear& model, double rows) {
  const double least = least_square(model);
  // Of the normal one all but what depends on the residual.
  const double volume = log_evidence(model) - 0.5 * (model.square - least);
  return volume + log_student(least, freedom_of(model, rows));
}

double log_student_field(const Eigen::MatrixXd& gram, const Eigen::VectorXd& match, double square,
                         double freedom, double least, double most, double* tau) {
  const Spectrum spectrum = spectrum_of(gram);
  const Eigen::VectorXd along = spectrum.vectors.transpose() * match;
  const double none = log_student(square, freedom);
  constexpr int kTaus = 28;
  std::vector<double> all;
  double best = -1e300;
  for (int k = 0; k < kTaus; ++k) {
    const double at = least * elementary::pow(most / least, k / (kTaus - 1.0)), variance = at * at;
    double volume = 0.0, explained = 0.0, decided = 0.0;
    for (Index i = 0; i < along.size(); ++i) {
      const double lambda = std::max(0.0, spectrum.values(i));
      const double spread = variance / (1.0 + variance * lambda);
      explained += along(i) * along(i) * spread;
      decided += lambda * spread;
      volume -= 0.5 * elementary::log1p(variance * lambda);
    }
    const double sum = volume + log_student(square - explained, freedom - decided) - none;
    if (sum > best && tau) *tau = at;
    best = std::max(best, sum);
    all.push_back(sum - elementary::log(double(kTaus)));
  }
  return log_sum(all);
}

}  // namespace dcnn::evidence
