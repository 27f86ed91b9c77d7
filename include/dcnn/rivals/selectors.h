// SPDX-License-Identifier: Apache-2.0
// Ways in which others choose the columns of a linear library, tuned as their users would.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace dcnn::rivals {

/// y = X theta + e as sums of products over blocks of time; columns are scaled to unit rms by the
/// caller.
struct Block {
  Eigen::MatrixXd xx;  ///< (P, P)
  Eigen::VectorXd xy;  ///< (P)
  double yy = 0.0, rows = 0.0;
};

/// Columns [begin, end) belong to one effect on one axis.
struct Group {
  Eigen::Index begin = 0, end = 0;
};

/// Sum of blocks, for instance of all but a fold.
Block sum(const std::vector<Block>& blocks);

/// argmin |y - X theta|^2 / (2 rows) + lambda |theta|_1 by coordinate descent.
Eigen::VectorXd lasso(const Block& all, double lambda);
/// Least squares, columns below `threshold` left out, again until none is (Brunton, Proctor, Kutz
/// 2016).
Eigen::VectorXd stlsq(const Block& all, double threshold);
/// The column that goes best with what is left, all chosen refitted, while BIC falls; at most 12.
Eigen::VectorXd matching_pursuit(const Block& all);

/// theta (P), zero where a column is not chosen; least squares on those that are.
using Selector =
    std::function<Eigen::VectorXd(const std::vector<Block>&, const std::vector<Group>&)>;

struct Method {
  std::string name;
  Selector select;
};

/// - `stlsq`: the threshold chosen by BIC on a grid (Mangan et al. 2017);
/// - `ensemble-stlsq`: the same on 50 resamplings of the blocks; columns in at least 60 % of them
///   (Fasel et al. 2022);
/// - `lasso-1se`, `lasso-min`: five folds of interleaved blocks, the one-standard-error rule or the
///   least error (Friedman, Hastie, Tibshirani 2010), refitted;
/// - `omp-bic`: orthogonal matching pursuit, stopped by BIC;
/// - `greedy-bic`: the group that lowers BIC most, until none does; at most 12 groups.
const std::vector<Method>& methods();

}  // namespace dcnn::rivals
