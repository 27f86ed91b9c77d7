// SPDX-License-Identifier: Apache-2.0
// A drawn arm: its limbs, its motion, what is hidden in it, and what its logs hold.
#pragma once

#include "conceal/arm_engine.h"
#include "conceal/draws.h"

namespace dcnn::conceal {

struct ArmLog {
  std::string name;
  bool holdout = false;
  Eigen::VectorXd t;
  Eigen::MatrixXd q, measured, clean, simulated;  ///< (T, joints): rad, N·m
};

struct ArmScenario {
  std::string id, group;
  std::vector<Limb> limbs;                ///< as the simulator at hand has them
  Eigen::Vector3d flange{0.0, 0.0, 0.0};  ///< origin of the flange in the last limb's frame
  bool described = true;                  ///< the limbs' bodies are in system.json
  std::vector<double> sigma;              ///< N·m, noise of each joint's torque
  std::string noise = "white";
  double encoder = 1e-6;       ///< rad
  std::vector<Hidden> hidden;  ///< axis: joint1, …, or empty for the arm
  std::vector<ArmLog> logs;
};

constexpr double kArmSeconds = 40.0;  ///< of a recording

/// An arm of six joints like those of common cobots, or of seven in a row that turn and bend.
std::vector<Limb> draw_limbs(std::size_t joints, Rng& rng);
/// (T, joints) at the world's rate: five tones in each joint, under a clock that stands still at
/// pauses.
Eigen::MatrixXd draw_angles(std::size_t joints, Rng& rng);
Eigen::Matrix3d drawn_turn(Rng& rng);

/// `arm` of a system's description; limbs are turned about x alone.
Json arm_json(const std::vector<Limb>& limbs, const Eigen::Vector3d& flange,
              const std::vector<std::string>& names, bool with_bodies);

/// Of an id of arm_plan(); the same arguments give the same bytes.
ArmScenario draw_arm(const std::string& id, std::uint64_t seed);

}  // namespace dcnn::conceal
