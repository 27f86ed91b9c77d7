// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/marginal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "core/linear_algebra.h"

namespace dcnn::evidence {
namespace {

constexpr double kRidge = 1e-10;  // of a column's square, where others hold it
constexpr int kTaus = 28;

/// X'X + P with unit diagonal, and the scales that make it so.
struct Scaled {
  Eigen::MatrixXd A;
  Eigen::VectorXd scale;  // 1/sqrt of the diagonal, 0 for columns of zeros
};

Scaled scaled(const Linear& model) {
  Eigen::MatrixXd A = model.gram;
  A.diagonal() += model.precision;
  const Eigen::VectorXd scale =
      A.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
  A = scale.asDiagonal() * A * scale.asDiagonal();
  for (Index k = 0; k < A.rows(); ++k) A(k, k) = 1.0 + kRidge;
  return {std::move(A), scale};
}

}  // namespace

Linear linear_model(const Eigen::MatrixXd& X, const Eigen::VectorXd& y,
                    const Eigen::VectorXd& precision) {
  return {X.transpose() * X, X.transpose() * y, y.squaredNorm(), precision};
}

double least_square(const Linear& model) {
  if (model.match.size() == 0) return model.square;
  const Scaled s = scaled(model);
  const Eigen::VectorXd match = s.scale.cwiseProduct(model.match);
  return model.square - match.dot(solve_symmetric(s.A, match).col(0));
}

double log_determinant(const Linear& model) {
  if (model.match.size() == 0) return 0.0;
  const Scaled s = scaled(model);
  double sum =
      2.0 *
      cholesky(s.A).diagonal().array().unaryExpr([](double d) { return elementary::log(d); }).sum();
  for (const double scale : s.scale) sum -= scale > 0.0 ? 2.0 * elementary::log(scale) : 0.0;
  return sum;
}

double log_evidence(const Linear& model) {
  double proper = 0.0, flat = 0.0;
  for (const double p : model.precision) {
    if (p > 0.0) {
      proper += elementary::log(p);
    } else {
      flat += elementary::log(2.0 * std::numbers::pi);
    }
  }
  return 0.5 * (model.square - least_square(model) - log_determinant(model) + proper + flat);
}

double log_field(const Eigen::MatrixXd& gram, const Eigen::VectorXd& match, double least,
                 double most, double* tau) {
  const Spectrum spectrum = spectrum_of(gram);
  const Eigen::VectorXd along = spectrum.vectors.transpose() * match;
  std::vector<double> all;
  double best = -1e300;
  for (int k = 0; k < kTaus; ++k) {
    const double at = least * elementary::pow(most / least, k / (kTaus - 1.0)), variance = at * at;
    double sum = 0.0;
    for (Index i = 0; i < along.size(); ++i) {
      const double lambda = std::max(0.0, spectrum.values(i));
      sum += 0.5 * (along(i) * along(i) * variance / (1.0 + variance * lambda) -
                    elementary::log1p(variance * lambda));
    }
    if (sum > best && tau) *tau = at;
    best = std::max(best, sum);
    all.push_back(sum - elementary::log(double(kTaus)));
  }
  return log_sum(all);
}

double log_sum(const std::vector<double>& logarithms) {
  if (logarithms.empty()) return -1e300;
  const double most = *std::max_element(logarithms.begin(), logarithms.end());
  double sum = 0.0;
  for (const double l : logarithms) sum += elementary::exp(l - most);
  return most + elementary::log(sum);
}

}  // namespace dcnn::evidence
