// SPDX-License-Identifier: Apache-2.0
// The errors of a shallow network over rows, for Levenberg-Marquardt.
#pragma once

#include "models/levenberg_marquardt.h"
#include "models/normal_blocks.h"

namespace dcnn {

/// e = scale_k·(target_k - output_k). Rows are summed in fixed pieces that are added in order: the
/// same bytes for any number of threads.
class ShallowResiduals : public NonlinearLeastSquares {
 public:
  /// `inputs` (N, inputs) and `targets` (N, outputs) as the network has them; `scale` (outputs) is
  /// what one of its units is worth in an error.
  ShallowResiduals(const ShallowNetwork& network, RowMatrix inputs, RowMatrix targets,
                   const Eigen::VectorXd& scale);

  double loss(const Eigen::VectorXd& weights) const override;
  NormalEquations linearise(const Eigen::VectorXd& weights) const override;

 private:
  /// Calls work(piece, signals, errors) for every few rows of every piece, in order within a piece.
  template <class Work>
  void for_each_chunk(const Eigen::VectorXd& weights, const Work& work) const;
  double count() const { return static_cast<double>(targets_.size()); }

  const ShallowNetwork& network_;
  RowMatrix inputs_, targets_;
  Eigen::VectorXd scale_;
  NormalBlocks blocks_;
};

}  // namespace dcnn
