// SPDX-License-Identifier: Apache-2.0
// A trained model compiled for one sample after another: what runs online.
#pragma once

#include <Eigen/Dense>

namespace dcnn {

/// Made by Model::predictor(), holds copies of all it needs. A stream pushed row by row gives what
/// Model::predict() gives for it, within rounding: the rows before the first one since the
/// beginning or reset() are taken to equal it. Not for several threads at once.
class Predictor {
 public:
  virtual ~Predictor() = default;
  /// Forgets what came before: a new stretch of time begins.
  virtual void reset() noexcept = 0;
  /// (targets) at the features x (F, SI units, finite) of the newest sample, in the targets' units;
  /// valid until the next call. Allocates, locks and throws nothing.
  virtual const Eigen::VectorXd& push(const Eigen::VectorXd& x) noexcept = 0;
};

}  // namespace dcnn
