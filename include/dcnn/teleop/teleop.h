// SPDX-License-Identifier: Apache-2.0
// The bilateral demonstration: hand and master, delayed link, slave with impedance,
// environment, and a force sensor whose tool an identifier compensates.
#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/models/identifier.h"
#include "dcnn/physics/simulator.h"

namespace dcnn {

/// SI; every number is an assumption of docs/use/teleop.md unless the configuration says otherwise.
struct TeleopConfig {
  double duration_s = 90.0;
  double master_mass = 1.5, hand_stiffness = 300.0, hand_damping = 20.0, master_damping = 5.0;
  double slave_mass = 4.0, slave_stiffness = 3000.0, slave_damping_ratio = 0.7;
  double slave_friction = 1.5, friction_speed = 0.005;
  double position_scale = 1.0, force_scale = 0.5, force_limit = 20.0, force_lowpass_hz = 30.0;
  double force_dead_zone = 0.0;  ///< N, of the estimated force
  double wall_z = -0.03, wall_stiffness = 1000.0, wall_damping = 10.0;
  double push_m = 0.045;         ///< how far below z = 0 the hand intends to go in the contact
  Index delay_ticks = 4;         ///< of 2 ms, each direction
  Index delay_jitter_ticks = 0;  ///< uniform extra delay of each packet
  double packet_loss = 0.0;      ///< probability
  bool passivity = false;        ///< passivity observer and controller at the master
  Simulator tool;                ///< what the simulated sensor feels
  double force_noise = 0.04;     ///< N, white
  Eigen::Vector3d orientation_center{0.0, 0.0, 3.14159265358979323846};
  double orientation_amplitude = 0.2617993877991494;             ///< rad
  Eigen::Matrix4d T_master_slave = Eigen::Matrix4d::Identity();  ///< frames of Fig. 1
  Eigen::Matrix4d T_base_tip = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d T_workspace_camera = Eigen::Matrix4d::Identity();
};

/// Keys as in configs/teleop.json; an unknown or impossible one is Error(kUsage).
TeleopConfig parse_teleop(const Json& json, const std::string& where);

/// What the tool itself does to the sensor, sample by sample from the slave's pose.
class Compensator {
 public:
  virtual ~Compensator() = default;
  /// Force in S [N] at this control tick; `position` [m] and `euler` (alpha, beta, gamma) of E.
  virtual Eigen::Vector3d push(const Eigen::Vector3d& position, const Eigen::Vector3d& euler) = 0;
};

/// A trained model behind its causal features. Error(kModel) for one that was not trained with
/// --online at 500 Hz or has no force. Windows fill as the motion goes on.
std::unique_ptr<Compensator> compensate_with(const Identifier& identifier,
                                             const std::string& where);
/// A simulator, e.g. the corrected one of dcnn-diagnose. Error(kData) where an effect needs the
/// future or a clock of its own (StreamingSimulator).
std::unique_ptr<Compensator> compensate_with(const Simulator& simulator, const std::string& where);

/// Which force the master is given.
struct Variant {
  enum class Kind { kIdeal, kNone, kMeasured };
  std::string name;
  Kind kind = Kind::kIdeal;
  std::unique_ptr<Compensator> compensator;  ///< kMeasured: taken off; null for the raw force
};

/// Signals at every control tick, (T,3) in B or (T).
struct TeleopTrace {
  Eigen::VectorXd t;
  Eigen::MatrixXd intended, master, slave;   ///< m
  Eigen::MatrixXd contact, estimated, felt;  ///< N: on the slave, as estimated, on the hand
  Eigen::MatrixXd orientation;               ///< rad
  Eigen::VectorXd energy;   ///< J that the link has taken from the hand since it was last free
  double dissipated = 0.0;  ///< J, by the passivity controller
};

/// Runs one variant; the same seed gives the same bytes. `R_ES` turns the sensor's force into E.
TeleopTrace run_teleop(const TeleopConfig& config, Variant& variant, const Eigen::Matrix3d& R_ES,
                       std::uint64_t seed);

/// A row of the report (errors along the wall's normal), with
/// `stable` and the energy monitor beside it.
Json summarise(const TeleopTrace& trace, const TeleopConfig& config, const std::string& name);

/// The hand's intended position at t, m.
Eigen::Vector3d intended_motion(double t, double push_m);

}  // namespace dcnn
