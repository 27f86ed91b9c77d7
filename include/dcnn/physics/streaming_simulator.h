// SPDX-License-Identifier: Apache-2.0
// A simulator that runs sample by sample behind a pose that comes online.
#pragma once

#include <memory>
#include <string>

#include "dcnn/data/streaming_features.h"
#include "dcnn/physics/simulator.h"

namespace dcnn {

/// simulate() for the motion up to the newest sample, its rates by a causal estimator. push()
/// allocates nothing.
class StreamingSimulator {
 public:
  /// Error(exit) naming `where` for an effect that cannot be known online: one that looks ahead
  /// (loose_load), is on the clock of a recording (drifts, step_bias, hum, intervals), belongs to
  /// one recording, or is a foreign force. `derivative` must be causal, `dt` is the sample time
  /// [s].
  StreamingSimulator(const Simulator& simulator, const DerivativeSpec& derivative, double dt,
                     const std::string& where, Exit exit);
  StreamingSimulator(StreamingSimulator&&) noexcept;
  ~StreamingSimulator();

  /// Force and torque of the tool in S [N, N*m; torque zero without an inertia]; the pose as in
  /// StreamingFeatures::push.
  const InstantWrench& push(const Eigen::Vector3d& position, const Eigen::Vector3d& euler);
  const InstantWrench& push(const Eigen::Vector3d& position, const Eigen::Vector4d& quaternion);
  /// A new stretch of time begins.
  void reset();
  bool has_torque() const { return model_.inertia.has_value(); }

 private:
  const InstantWrench& advance(const Eigen::VectorXd& x, const Eigen::Matrix3d& R_BE,
                               Eigen::Vector3d euler);

  ToolModel model_;
  std::vector<EffectStream> before_bias_, after_bias_;
  StreamingFeatures features_;
  Eigen::Matrix3d R_ES_;
  Instant now_;
  InstantWrench wrench_;
};

/// Whether an effect can be known sample by sample, as they come.
bool runs_online(const EffectSpec& effect);
/// The effects of a simulator that run online, the names of the others in `left_out`.
Simulator online_part(const Simulator& simulator, std::vector<std::string>& left_out);

}  // namespace dcnn
