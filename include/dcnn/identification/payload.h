// SPDX-License-Identifier: Apache-2.0
// A tool's mass, centre of mass and inertia for robots and simulators of others.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/physics/tool_model.h"

namespace dcnn {

/// A body on the flange, SI, in the flange's frame E (the frame whose pose the robot reports).
struct PayloadBody {
  double mass = 0.0;
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  std::optional<Eigen::Matrix3d> inertia_com;  ///< about the centre of mass, axes of E
  std::vector<std::string> assumed = {};       ///< keys of sim.json that no recording showed

  /// Moments about the principal axes, and the axes as columns of a rotation; zeros without
  /// inertia.
  Eigen::Vector3d moments() const;
  Eigen::Matrix3d axes() const;
};

/// The tool of sim.json behind its mounting.
PayloadBody payload_of(const ToolModel& model);

/// urdf, sdf, mujoco, ur, franka, kuka, abb, ros2-yaml.
std::vector<std::string> payload_formats();
/// "NOT IDENTIFIED: the recordings do not show the inertia; …", one sentence; empty where they show
/// all. It stands in the comment of every format.
std::string not_identified(const PayloadBody& payload);
/// The name of the file that a format is written to ("payload.urdf").
std::string payload_file(const std::string& format);
/// Its text; frames and units stand in comments. Where no inertia is known, zeros are written and
/// said (MuJoCo, which takes no zeros: 1e-9).
std::string payload_text(const std::string& format, const PayloadBody& payload);

}  // namespace dcnn
