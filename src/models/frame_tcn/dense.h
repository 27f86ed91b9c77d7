// SPDX-License-Identifier: Apache-2.0
// In place of convolutions and gates, as a control: two hidden layers of tanh units beside a dense
// linear part, from the block means and the levels to the channels.
#pragma once

#include <Eigen/Dense>

#include "dcnn/core/random.h"
#include "models/frame_tcn/blocks.h"

namespace dcnn::frame_tcn {

/// Parameters live in a flat vector: the linear part, then weights and offsets layer by layer.
struct Dense {
  static constexpr Index kInputs = kChannels * kBlocks + kChannels;  // means, then levels
  static constexpr Index kFirst = 128, kSecond = 64;
  /// What a pass leaves for the gradient, a column a sample.
  struct Signals {
    Eigen::MatrixXd inputs, first, second;
  };

  static Index size();
  /// Small random weights; the linear part is zero.
  static void start(Eigen::Ref<Eigen::VectorXd> p, Rng& rng);
  /// The linear part (15, kInputs) in the parameters.
  static Eigen::Map<Eigen::MatrixXd> linear(double* p) { return {p, kChannels, kInputs}; }

  /// clean (15, n) of block means (720, n), channel by channel, and levels (15, n).
  static void forward(const double* p, const Eigen::MatrixXd& means, const Eigen::MatrixXd& levels,
                      Signals& s, Eigen::MatrixXd& clean);
  /// Adds dLoss/dp to `gradient` for dLoss/dclean (15, n).
  static void backward(const double* p, const Signals& s, const Eigen::MatrixXd& d_clean,
                       double* gradient);
};

}  // namespace dcnn::frame_tcn
