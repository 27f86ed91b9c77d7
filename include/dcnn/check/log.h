// SPDX-License-Identifier: Apache-2.0
// A log as it is written, before anything is believed about it: columns, roles, rows.
#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/data/recording.h"
#include "dcnn/physics/chain.h"
#include "dcnn/physics/tool_model.h"

namespace dcnn::check {

/// Columns of one joint or machine axis; empty names mean "not there".
struct Joint {
  std::string name, position, velocity, measured;
  bool turns = true;   ///< position in rad, else in m
  double scale = 1.0;  ///< declared, of the measured column
};

/// What the user declares about the log.
struct Declared {
  ReadOptions read;                ///< units and sign, as every tool takes them
  System system;                   ///< of another machine than a wrist
  std::optional<ToolModel> model;  ///< sim.json: nominal mass and mounting
  std::optional<JointChain> arm;   ///< with the bodies of its links; see describe_arm()
};

struct Log {
  std::string name;  ///< the file's name without its folder
  Table table;       ///< values as logged
  Declared declared;
  std::vector<Joint> joints;
  std::vector<std::size_t> arm;  ///< place in `joints` of each joint of the arm; empty without one

  Eigen::VectorXd t;    ///< (T) as logged, from 0; empty without a clock
  double step = 0.0;    ///< median of its steps; 0 without a clock
  bool smooth = false;  ///< neighbouring rows are near each other, as samples of a motion are
  std::vector<Segment> segments;  ///< without a gap of more than 5 steps
  Eigen::Index burst = 0;  ///< rows that are stamped at once, where `step` is the mean; 0 elsewhere

  Eigen::Index rows() const { return table.values.rows(); }
  bool has(const std::string& column) const;
  bool has_all(const std::vector<std::string>& columns) const;
  Eigen::VectorXd column(const std::string& name) const;
  Eigen::MatrixXd block(const std::vector<std::string>& columns) const;

  bool has_quaternion() const { return has_all(kQuaternion); }
  bool has_pose() const { return has_quaternion() || has_all(kEuler); }
  bool is_wrist() const;
  /// Measured columns of one sensor each: forces, torques, or those of a joint.
  std::vector<std::vector<std::string>> sensors() const;
  /// Columns of the pose or the joints' positions.
  std::vector<std::string> positions() const;
};

/// Of any table. Columns of joints are those of the system description, else recognised by the
/// names q_1, qd_1 and tau_1.
Log make_log(const std::string& name, Table table, const Declared& declared);
/// Declares the arm whose joints are logged: by their names where all are among the log's (which
/// may have more, a gripper's), else in their order. Error(kData) where their numbers differ then,
/// or where a position or torque is missing.
void describe_arm(Log& log, const JointChain& chain);
/// Reads a CSV; what cannot be read is an Error(kData).
Log read_log(const std::filesystem::path& path, const Declared& declared);

}  // namespace dcnn::check
