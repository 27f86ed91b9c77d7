// SPDX-License-Identifier: Apache-2.0
// frame-tcn: a causal convolutional network on the pose and its rates. Convolutions per kinematic
// axis (closed form), gates by the level of noise, rigid-body frames, a product head.
#pragma once

#include <string>
#include <vector>

#include "dcnn/models/model.h"
#include "models/frame_tcn/front.h"
#include "models/frame_tcn/net.h"
#include "models/frame_tcn/novelty.h"
#include "models/frame_tcn/pace.h"

namespace dcnn::frame_tcn {

/// Configuration of the model and of its training.
struct Spec {
  bool line = false;                    ///< a fixed line fit in place of the learned convolutions
  bool gates = true;                    ///< else one filter per channel
  bool dense = false;                   ///< dense layers in place of convolutions and gates
  bool saturation = true;               ///< tanh units in the head
  std::vector<double> speeds;           ///< paces of the motion that the filters are made for
  std::vector<double> x_snr, pose_snr;  ///< dB, one expert each; empty where not trained for
  NoiseSpec noise;
  Index epochs = 30, steps = 100;  ///< half of the epochs for the gates, half for the head
  double gate_rate = 5e-3, head_rate = 2e-3, ema = 0.998;
  Eigen::Matrix3d mounting = Eigen::Matrix3d::Identity();  ///< R_ES
  FeatureLayout layout;                                    ///< colours noise on the pose
  std::uint64_t seed = 0;

  static Spec parse(const Problem& problem);
  Index experts() const;
};

/// With 8 experts 19 828 parameters: 14 976 in the convolutions, 3 384 in the gates, 1 066 in the
/// gains and scales, 402 in the head; about 20 000 multiply-adds a prediction. 39 624 more are the
/// convolutions of a segment's first 503 rows.
class FrameTcn : public Model {
 public:
  explicit FrameTcn(const Problem& problem);
  FrameTcn(const Container& file, const std::string& where);

  bool fit(const Samples& training, const Samples& validation, FitSession& session) override;
  Eigen::MatrixXd predict(const Stream& stream) const override;
  std::unique_ptr<Predictor> predictor() const override;
  Index parameter_count() const override;
  const InputMap& map() const override { return map_; }
  void save(Container& file) const override;

  /// The larger of two scores. Above 1 is what less than one held-out row in 10^4 was (validation
  /// rows, else the last 15 % of the training), or accelerations of the last four seconds that less
  /// than one training row in 10^3 reached at the paces the filters are made for.
  Eigen::VectorXd novelty(const Stream& stream) const override;

 private:
  friend class Recipe;
  struct Slot {
    std::string name;
    Eigen::MatrixXd value;
  };
  /// What the file holds besides the network's plan.
  std::vector<Slot> slots() const;
  Eigen::VectorXd pace_score(const Eigen::MatrixXd& x, const std::vector<Segment>& segments) const;
  void assign(const std::vector<Slot>& slots);

  Spec spec_;
  std::vector<std::string> units_;
  InputMap map_;
  Front front_;
  Net net_;
  Eigen::VectorXd spread_;  // (triples) N or N·m
  Novelty novelty_;
  Pace pace_;
};

}  // namespace dcnn::frame_tcn
