// SPDX-License-Identifier: Apache-2.0
// Online compensation as one component (Fig. 3): pose and force in, external force in the robot
// frame out, one call per sample.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/models/identifier.h"
#include "dcnn/models/predictor.h"
#include "dcnn/physics/streaming_simulator.h"
#include "dcnn/runtime/guard.h"

namespace dcnn {

/// What robot and sensor say at one instant. Numbers may be anything.
struct OnlineSample {
  double t = 0.0;                                      ///< s, on the robot's clock
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< origin of E in B, m
  Eigen::Vector4d quaternion{1, 0, 0, 0};              ///< (w, x, y, z) of E in B
  std::optional<Eigen::Vector3d> euler;  ///< (alpha, beta, gamma) instead of the quaternion, rad
  Vector6d wrench = Vector6d::Zero();    ///< of the tool on the sensor, in S
  bool rearm = false;  ///< the operator's word that a fault is over; its rising edge counts
};

struct OnlineResult {
  double t = 0.0;                        ///< of the sample that it answers
  Vector6d tool = Vector6d::Zero();      ///< of the tool on the sensor, in S, as predicted
  Vector6d external = Vector6d::Zero();  ///< on the tool, in B; finite, bounded, slew-limited
  RunState state = RunState::kWarmup;
  Reason reason = Reason::kWarmup;
  bool contact = false;  ///< the external force is above what the model's error explains
  bool limited = false;  ///< held back by a limit
  double novelty = 0.0;  ///< above 1: motion unlike training; 0 without an envelope
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  ///< tracked, in S, taken off the measured force
};

struct CompensatorOptions {
  GuardLimits guard;  ///< warmup_cycles is set to the windows' length where it is shorter
  Eigen::Matrix3d R_ES = Eigen::Matrix3d::Identity();  ///< of the calibration
  int average = 1;                   ///< linearly weighted mean of so many readings (1 to 16; D30)
  double bias_seconds = 0.0;         ///< time constant of the bias tracker; 0: none
  double bias_limit_n = 2.0;         ///< most that it may take off, per axis
  std::optional<double> contact_n;   ///< instead of the model file's threshold
  std::optional<Envelope> envelope;  ///< instead of the model file's
  int longest_bridge = 4;  ///< missing samples in a row that are bridged by straight lines
};

/// A model and a fallback behind their causal features, envelope, bias tracker, contact detector
/// and guard. step() and miss() allocate, lock and throw nothing.
class OnlineCompensator {
 public:
  /// `network` or `physics` or both. Error(kModel) or Error(kData) naming `where` for what cannot
  /// run online.
  OnlineCompensator(const Identifier* network, const Simulator* physics,
                    const CompensatorOptions& options, const std::string& where);
  OnlineCompensator(OnlineCompensator&&) noexcept;
  ~OnlineCompensator();

  const OnlineResult& step(const OnlineSample& sample) noexcept;
  /// A cycle in which no sample came.
  const OnlineResult& miss() noexcept;
  /// The last cycle took longer than a sample: the network is not followed in the next one.
  void overrun() noexcept { overrun_ = true; }

  double dt() const { return dt_; }            ///< s
  bool has_torque() const { return torque_; }  ///< tx, ty, tz are predicted as well
  bool has_fallback() const { return physics_ != nullptr; }
  bool has_envelope() const { return envelope_.features() > 0; }
  std::optional<double> contact_n() const { return contact_n_; }

 private:
  static constexpr std::size_t kReadings = 16, kWindow = 128;

  void load(const Identifier& identifier, const std::string& where);
  Reason tell_time(const OnlineSample& sample) noexcept;
  void feed(const Eigen::Vector3d& position, const Eigen::Vector4d& quaternion,
            const std::optional<Eigen::Vector3d>& euler) noexcept;
  void bridge(const OnlineSample& sample, Index steps) noexcept;
  void start_anew() noexcept;
  Vector6d averaged(const Vector6d& wrench) noexcept;
  Reason distrust() noexcept;
  void watch_contact(const Eigen::Vector3d& external) noexcept;
  void track_bias(const Eigen::Vector3d& external_S) noexcept;
  const OnlineResult& publish(const Cycle& cycle) noexcept;

  CompensatorOptions options_;
  double dt_ = 0.002;
  bool torque_ = false, euler_features_ = false;
  // The network: features, prediction, and where each target stands in a wrench.
  std::unique_ptr<StreamingFeatures> features_;
  std::unique_ptr<Predictor> predictor_;
  std::unique_ptr<StreamingSimulator> base_, physics_;
  std::vector<Index> places_;
  Envelope envelope_;
  std::optional<double> contact_n_;
  Guard guard_;

  OnlineResult result_;
  const Eigen::VectorXd* x_ = nullptr;  // features of the newest sample
  Vector6d predicted_ = Vector6d::Zero(), simulated_ = Vector6d::Zero();
  bool started_ = false, overrun_ = false, rearm_before_ = false;
  // Samples in a row whose clock is steady but behind the one that was followed.
  int other_clock_ = 0;
  double other_t_ = 0.0;
  int settling_ = 0;  // samples until the windows hold no sample from before a gap
  OnlineSample last_;
  std::array<Vector6d, kReadings> readings_;
  std::size_t reading_ = 0, readings_held_ = 0;
  std::array<Eigen::Vector3d, kWindow> forces_;
  std::size_t window_ = 1, force_ = 0;
  Index quiet_ = 0;
};

}  // namespace dcnn
