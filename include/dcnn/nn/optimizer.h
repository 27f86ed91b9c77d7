// SPDX-License-Identifier: Apache-2.0
// Adam, learning-rate schedules and weight averaging.
#pragma once

#include <vector>

#include "dcnn/nn/layer.h"

namespace dcnn {

/// Adam (Kingma and Ba 2015, Algorithm 1), bias-corrected; L2 is added to the gradient of weights.
class Adam {
 public:
  struct Settings {
    double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-8;
    double l2 = 1e-4;
    double clip = 0;  ///< most L2 norm of the loss's gradient by each tensor, 0 for no limit
  };
  Adam(std::vector<NamedTensor> parameters, Settings settings);

  /// One step at the given rate from the gradients, which are then cleared.
  void step(double rate);

  Index steps() const { return steps_; }
  /// The moments, for checkpoints: named as the parameters with ".m" and ".v".
  std::vector<NamedTensor> state() const;
  void set_steps(Index steps) { steps_ = steps; }

 private:
  std::vector<NamedTensor> parameters_;
  std::vector<Tensor> first_, second_;
  Settings settings_;
  Index steps_ = 0;
};

/// lr(epoch): constant, piecewise constant (lr0·factor^floor((e-1)/period)) or cosine to
/// zero.
class LearningRate {
 public:
  /// Keys: lr, schedule (constant|piecewise|cosine), drop_factor, drop_period.
  LearningRate(Options& training, Index epochs, Index steps_per_epoch);
  /// `epoch` and `step` from 0.
  double at(Index epoch, Index step) const;

 private:
  enum class Kind { kConstant, kPiecewise, kCosine } kind_;
  double initial_, factor_;
  Index period_, total_steps_, steps_per_epoch_;
};

/// Exponential moving average of parameters (EMA): a += (1 - decay)·(w - a), from the first step.
class WeightAverage {
 public:
  WeightAverage(std::vector<NamedTensor> parameters, double decay);
  void update();
  /// Exchanges the averaged values and the parameters' own.
  void swap();
  std::vector<NamedTensor> state() const;  // named ".ema"

 private:
  std::vector<NamedTensor> parameters_;
  std::vector<Tensor> averages_;
  double decay_;
};

}  // namespace dcnn
