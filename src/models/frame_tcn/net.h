// SPDX-License-Identifier: Apache-2.0
// Gates, frames and head on a batch of columns, with gradients by hand (tested by differences).
#pragma once

#include <vector>

#include "dcnn/core/random.h"
#include "models/frame_tcn/blocks.h"
#include "models/frame_tcn/dense.h"
#include "models/frame_tcn/frame.h"
#include "models/frame_tcn/mlp.h"

namespace dcnn::frame_tcn {

constexpr Index kSmooth = 22;      ///< 1, a, v, R^T v, omega, alpha, 6 products of omega
constexpr Index kSaturating = 45;  ///< tanh(u/s) of u in {v, R^T v, omega}, 5 scales each
constexpr Index kScales = 5;

/// What a batch came to, layer by layer; n columns.
struct Pass {
  Eigen::MatrixXd levels;   ///< (15, n) standardised: given
  Eigen::MatrixXd experts;  ///< (15·experts, n) estimates by the convolutions: given
  Dense::Signals dense;
  Eigen::MatrixXd gate_hidden, share, clean;  ///< clean (15, n): denoised, in units of scale
  Eigen::MatrixXd gain_hidden, gain, tanh, z, in_world;
  Eigen::MatrixXd out;  ///< (3·triples, n), in units of the spread
  std::vector<Frame> frames;
  Index columns() const { return experts.cols(); }
};

class Net {
 public:
  struct Plan {
    Index experts = 8;
    Index triples = 1;  ///< force, then torque
    bool saturation = true;
    bool dense = false;  ///< dense layers in place of gates; experts are then the block means
  };
  Net() = default;
  Net(const Plan& plan, Rng& rng);

  /// Parameters of what makes channels of the experts: gates or dense layers.
  Index gate_size() const {
    return plan_.dense ? Dense::size() : plan_.experts > 1 ? gate_.size() : 0;
  }
  Index columns_z() const { return kSmooth + (plan_.saturation ? kSaturating : 0); }
  const Plan& plan() const { return plan_; }

  /// Standardised levels of a roughness (15, n). One that is not known equals the mean of those
  /// that are; where none is, noise is taken to be the worst of the training.
  Eigen::MatrixXd standard_levels(const Eigen::MatrixXd& roughness) const;
  void put_standard_levels(const Eigen::MatrixXd& roughness, Eigen::MatrixXd& standard) const;
  /// Shares of the experts by the levels of noise, and the channels they make.
  void denoise(Pass& pass) const;
  /// z of the denoised channels: everything before the last linear map.
  void features(Pass& pass) const;
  /// out = R^T(World^T z) + Sensor^T z of each triple.
  void product(Pass& pass) const;

  /// Adds dLoss/dparameters for a given dLoss/dclean (15, n).
  void pull_back_denoise(const Pass& pass, const Eigen::MatrixXd& d_clean,
                         Eigen::VectorXd& gradient) const;
  /// The same for dLoss/dout; gives dLoss/dclean.
  Eigen::MatrixXd pull_back_head(const Pass& pass, const Eigen::MatrixXd& d_out,
                                 Eigen::VectorXd& gradient) const;

  /// Maps of one triple's matrices (columns_z, 3) in the parameters.
  Eigen::Map<const Eigen::MatrixXd> world(Index triple) const;
  Eigen::Map<const Eigen::MatrixXd> sensor(Index triple) const;
  Index world_begin(Index triple) const;

  Eigen::VectorXd parameters;   ///< gate, gain, log scales, then world and sensor of each triple
  Eigen::VectorXd mean, scale;  ///< (15) of the channels, SI
  Index edge = 0;  ///< rows at a segment's start whose rates say nothing about the noise
  Eigen::VectorXd level_noisy;  ///< (15) standardised, of the worst noise of the training
  Eigen::VectorXd level_mean, level_scale;                 ///< (15)
  Eigen::VectorXd unit;                                    ///< (22) divides the smooth part of z
  Eigen::Matrix3d mounting = Eigen::Matrix3d::Identity();  ///< R_ES
  /// Sets the saturating scales to a log grid .004 to .3 of the given rms of v, R^T v, omega (9).
  void start_scales(const Eigen::VectorXd& rms);

 private:
  Index gain_begin() const { return gate_size(); }
  Index scale_begin() const { return gain_begin() + (plan_.saturation ? gain_.size() : 0); }
  Index head_begin() const { return scale_begin() + (plan_.saturation ? kSaturating : 0); }
  void pull_back_units(const Pass& pass, Index column, const Eigen::VectorXd& dz,
                       Eigen::MatrixXd& d_gain, Eigen::VectorXd& gradient,
                       Eigen::Matrix<double, 9, 1>& du) const;

  Plan plan_;
  Mlp gate_, gain_;
};

}  // namespace dcnn::frame_tcn
