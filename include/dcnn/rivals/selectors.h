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

/// theta (P), zero where a column is not chosen; least squares on those that are.
using Selector =
    std::function<Eigen::VectorXd(const std::vector<Block>&, const std::vector<Group>&)>;

struct Method {
  std::string name;
  Selector select;
};

/// - `stlsq`: sequentially thresholded least squares (Brunton, Proctor, Kutz 2016), ridge 1e-6,
///   the threshold chosen by BIC on a grid;
/// - `ensemble-stlsq`: the same on 50 resamplings of the blocks; columns in at least 60 % of them
///   (Fasel et al. 2022);
/// - `lasso-cv`: coordinate descent, five folds of blocks, the one-standard-error rule, refitted;
/// - `omp-bic`: orthogonal matching pursuit, stopped by BIC;
/// - `greedy-bic`: the group that lowers the error most, stopped by BIC.
const std::vector<Method>& methods();

}  // namespace dcnn::rivals
