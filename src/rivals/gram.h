// SPDX-License-Identifier: Apache-2.0
// Least squares on a subset of columns, from sums of products.
#pragma once

#include "dcnn/rivals/selectors.h"

namespace dcnn::rivals {

using Columns = std::vector<Eigen::Index>;

struct Fit {
  Eigen::VectorXd theta;  ///< (P)
  double error = 0.0;     ///< sum of squares
};

Fit least_squares(const Block& all, const Columns& chosen);
/// n log(error / n) + k log n.
double bic(const Block& all, const Fit& fit, std::size_t columns);
double error_of(const Block& block, const Eigen::VectorXd& theta);

/// Which penalty of a path cross-validation takes.
enum class Rule { kMinimum, kOneStandardError };
Eigen::VectorXd lasso_cv(const std::vector<Block>& blocks, Rule rule);

}  // namespace dcnn::rivals
