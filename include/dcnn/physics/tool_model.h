// SPDX-License-Identifier: Apache-2.0
// sim.json: the numbers of a rigid tool on a wrist sensor.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>

#include "dcnn/core/json.h"

namespace dcnn {

/// A rigid tool and its sensor, SI, in S where not said.
struct ToolModel {
  /// Which terms of the rigid body are simulated.
  enum class Inertial {
    kFull,    ///< all
    kLinear,  ///< gravity and -m·a of the sensor's origin
    kNone,    ///< gravity alone
  };

  double mass = 0.0;
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  std::optional<Eigen::Matrix3d>
      inertia;  ///< about the origin of S; torques are simulated if given
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< in B
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d bias_torque = Eigen::Vector3d::Zero();
  Eigen::Vector3d sensor_rotation_rpy = Eigen::Vector3d::Zero();  ///< (rx, ry, rz)
  Inertial inertial = Inertial::kFull;
  double sample_rate_hz = 500.0;

  Eigen::Matrix3d R_ES() const;  ///< Rz(rz)·Ry(ry)·Rx(rx): the sensor's mounting
};

/// Keys: tool.{mass_kg, com_m, inertia_kgm2 [ixx,iyy,izz,ixy,ixz,iyz]}, gravity_mps2,
/// sensor.{bias_n, bias_nm, rotation_rpy}, model.inertial (full|linear|none), sample_rate_hz.
/// A missing mass, an unknown key or an impossible number is an Error(exit) naming `where`.
ToolModel parse_tool_model(const Json& json, const std::string& where, Exit exit);
Json to_json(const ToolModel& model);

}  // namespace dcnn
