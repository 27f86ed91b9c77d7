// SPDX-License-Identifier: Apache-2.0
// Products of the values of a row, row by row, and their sums over rows.
#pragma once

#include <Eigen/Dense>

#include "dcnn/core/parallel.h"

namespace dcnn {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// to (n, count·(count + 1)/2) = (or +=) x_i·x_j, i <= j, of every row, for `count` columns of x
/// (n, any) from `first` on.
void pair_products(const RowMatrix& x, Index first, Index count, bool add, RowMatrix& to);

/// to (n, x_count·y_count) = (or +=) x_i·y_j of every row, for such stretches of x and y.
void all_products(const RowMatrix& x, Index x_first, Index x_count, const RowMatrix& y,
                  Index y_first, Index y_count, bool add, RowMatrix& to);

/// sums (a.cols, b.cols), row-major, += a^T·b.
void add_product(const RowMatrix& a, const RowMatrix& b, double* sums);

}  // namespace dcnn
