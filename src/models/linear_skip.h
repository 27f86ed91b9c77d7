// SPDX-License-Identifier: Apache-2.0
// The linear part of a network: ridge regression on the network's own inputs.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/models/network_input.h"

namespace dcnn {

/// y = offset + W·inputs, fitted once and then left alone. The network beside it learns what it
/// leaves, so that convolutions need not spend themselves on a plane through the data.
class LinearSkip {
 public:
  /// Least squares over the training rows at every noise level in turn, with kRidge·rows added to
  /// the diagonal (not to the offset's). `seed` feeds the draws of noise.
  static LinearSkip fit(const Samples& training, const NoiseSpec& noise, const InputMap& map,
                        const NetworkInput& input, std::uint64_t seed);
  static constexpr double kRidge = 1e-4;

  /// (n, targets) for inputs (n, …).
  Eigen::MatrixXd of(const Tensor& inputs) const;
  /// (targets) for one sample's inputs; allocates nothing.
  void of(const Real* inputs, Eigen::VectorXd& y) const noexcept;

  /// The sums of A^T A, A^T Y and Y^2 over the rows at one level of noise.
  struct Gram {
    Eigen::MatrixXd inputs, moment;
    Eigen::VectorXd targets;
    double rows;
  };

  /// Weight of the training rows at each level of noise: the inverse of the rms that the fit
  /// leaves of them, 1 on average. Unweighted, the loudest level would own the fit; by the inverse
  /// mean square, the quiet ones.
  const std::vector<double>& level_weights() const { return level_weights_; }
  /// Root of the weighted mean square that the fit left of each target, noisy rows included.
  const Eigen::VectorXd& residual() const { return residual_; }
  Index targets() const { return weights_.cols(); }
  Index parameter_count() const { return weights_.size(); }

  void save(Container& file) const;
  /// For `cells` inputs; Error(kModel).
  static LinearSkip load(const Container& file, Index cells, const std::string& where);

 private:
  void solve(const std::vector<Gram>& grams);
  void weigh(const std::vector<Gram>& grams);

  std::vector<double> level_weights_;
  Eigen::MatrixXd weights_;  // (1 + cells, targets), offset first
  Eigen::VectorXd residual_;
};

}  // namespace dcnn
