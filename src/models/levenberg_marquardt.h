// SPDX-License-Identifier: Apache-2.0
// Levenberg-Marquardt as the toolbox runs it (Hagan and Menhaj 1994).
#pragma once

#include <Eigen/Dense>

#include "dcnn/core/parallel.h"
#include "dcnn/models/container.h"

namespace dcnn {

/// J^T J/n and J^T e/n of n errors e, with J = de/dw.
struct NormalEquations {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
};

/// Errors whose squares are to be small.
class NonlinearLeastSquares {
 public:
  virtual ~NonlinearLeastSquares() = default;
  virtual double loss(const Eigen::VectorXd& weights) const = 0;  ///< mean square of the errors
  virtual NormalEquations linearise(const Eigen::VectorXd& weights) const = 0;
};

class LevenbergMarquardt {
 public:
  struct Settings {
    Index epochs = 1000;
    double mu = 1e-3, decrease = 0.1, increase = 10.0, least_mu = 1e-20, most_mu = 1e10;
    double least_gradient = 1e-7;  ///< of the norm of the gradient of the loss
    Index most_failures = 6;       ///< epochs in a row without a better validation loss
  };

  /// Without `validation` the last weights are the best ones.
  LevenbergMarquardt(const NonlinearLeastSquares& training, const NonlinearLeastSquares* validation,
                     const Settings& settings, Eigen::VectorXd start);

  bool done() const;
  /// One epoch: a step that lowers the training loss. False where there is none any more; then it
  /// is done.
  bool iterate();

  const Eigen::VectorXd& weights() const { return weights_; }
  const Eigen::VectorXd& best() const { return best_; }
  bool is_best() const { return best_epoch_ == epoch_; }  ///< the last epoch has the best weights
  double loss() const { return loss_; }
  double mu() const { return mu_; }
  Index epoch() const { return epoch_; }  ///< epochs done

  /// The whole state; restore() goes on to the same bytes. A state that does not fit is
  /// Error(kModel).
  Container save() const;
  void restore(const Container& file);

 private:
  bool step(const NormalEquations& equations);
  void validate();

  const NonlinearLeastSquares& training_;
  const NonlinearLeastSquares* validation_;
  Settings settings_;
  Eigen::VectorXd weights_, best_;
  double mu_, loss_, best_loss_ = 0.0;
  Index epoch_ = 0, best_epoch_ = 0, failures_ = 0;
  bool stuck_ = false;
};

}  // namespace dcnn
