// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "rivals/gram.h"

namespace dcnn::rivals {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
constexpr int kFolds = 5;

/// Cyclic coordinate descent (Friedman, Hastie, Tibshirani 2010) from `theta` on, penalty lambda
/// per row.
void descend(const Block& b, double lambda, VectorXd& theta) {
  VectorXd left = b.xy - b.xx * theta;
  for (int sweep = 0; sweep < 300; ++sweep) {
    double largest = 0.0;
    for (Index c = 0; c < theta.size(); ++c) {
      const double curvature = b.xx(c, c);
      if (curvature <= 0.0) continue;
      const double raw = left(c) + curvature * theta(c);
      const double shrunk = std::max(0.0, std::abs(raw) - lambda * b.rows) / curvature;
      const double step = std::copysign(shrunk, raw) - theta(c);
      if (step == 0.0) continue;
      theta(c) += step;
      left -= step * b.xx.col(c);
      largest = std::max(largest, std::abs(step));
    }
    if (largest < 1e-5 * std::sqrt(b.yy / b.rows)) break;
  }
}

std::vector<double> path_of(const Block& all) {
  std::vector<double> lambdas;
  const double largest = all.xy.cwiseAbs().maxCoeff() / all.rows;
  for (int k = 0; k < 25; ++k) lambdas.push_back(largest * std::pow(10.0, -3.0 * k / 24.0));
  return lambdas;
}

}  // namespace

VectorXd lasso(const Block& all, double lambda) {
  VectorXd theta = VectorXd::Zero(all.xy.size());
  descend(all, lambda, theta);
  return theta;
}

VectorXd lasso_cv(const std::vector<Block>& blocks, Rule rule) {
  const Block all = sum(blocks);
  const std::vector<double> lambdas = path_of(all);
  Eigen::MatrixXd error(kFolds, static_cast<Index>(lambdas.size()));
  for (int fold = 0; fold < kFolds; ++fold) {
    std::vector<Block> train, test;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      (static_cast<int>(k) % kFolds == fold ? test : train).push_back(blocks[k]);
    }
    if (test.empty() || train.empty()) return VectorXd::Zero(all.xy.size());
    const Block fit = sum(train), judge = sum(test);
    VectorXd theta = VectorXd::Zero(all.xy.size());
    for (std::size_t l = 0; l < lambdas.size(); ++l) {
      descend(fit, lambdas[l], theta);
      error(fold, static_cast<Index>(l)) = error_of(judge, theta) / judge.rows;
    }
  }
  const Eigen::RowVectorXd mean = error.colwise().mean();
  Index best = 0;
  mean.minCoeff(&best);
  const double sd = std::sqrt((error.col(best).array() - mean(best)).square().sum() / (kFolds - 1));
  const double allowed = rule == Rule::kMinimum ? 0.0 : sd / std::sqrt(static_cast<double>(kFolds));
  Index l = 0;
  while (mean(l) > mean(best) + allowed) ++l;
  VectorXd theta = VectorXd::Zero(all.xy.size());
  for (Index k = 0; k <= l; ++k) descend(all, lambdas[static_cast<std::size_t>(k)], theta);
  Columns chosen;
  for (Index c = 0; c < theta.size(); ++c) {
    if (theta(c) != 0.0) chosen.push_back(c);
  }
  return least_squares(all, chosen).theta;
}

}  // namespace dcnn::rivals
