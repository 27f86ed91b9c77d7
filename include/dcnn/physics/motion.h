// SPDX-License-Identifier: Apache-2.0
// What the force depends on: the motion of the sensor frame, from a recording or from formulae.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/data/derivative.h"
#include "dcnn/data/recording.h"
#include "dcnn/physics/tool_model.h"
#include "dcnn/physics/trajectory.h"

namespace dcnn {

/// What a recording has beside motion and force, such as a pressure or a current.
struct LoggedSignal {
  std::string name;        ///< of its column
  Eigen::VectorXd values;  ///< (T), in the log's unit
};

/// Motion of the sensor frame, T samples, SI; a block is (T,3).
struct Motion {
  std::string recording;  ///< name of the file, for effects that act in one recording only
  Eigen::VectorXd t;      ///< s; in a list of poses without time the number of the row
  std::vector<Eigen::Matrix3d> R_BS;
  Eigen::MatrixXd euler;      ///< alpha, beta, gamma of E, continuous
  Eigen::MatrixXd v_B, a_B;   ///< of the sensor's origin, in B; (0,3) where nothing logged tells it
  Eigen::MatrixXd p_B;        ///< position of the sensor's origin as logged; (0,3) where it is not
  Eigen::MatrixXd w_S, dw_S;  ///< angular velocity and acceleration, in S
  Eigen::VectorXd temperature;        ///< degC, empty where not logged
  std::vector<LoggedSignal> signals;  ///< that strengths of laws may follow
  double dt = 0.0;                    ///< s; 0 for a list of poses at rest
  bool has_clock = true;              ///< t is a time
  bool of_axis = false;               ///< of one axis of a machine (axis_machine.h), not of a tool
  std::vector<Segment> segments;
  /// Of fast motion that is derived from the pose, half a second at either end of a segment lacks a
  /// part.
  bool is_fast = false;

  Index samples() const { return t.size(); }
  bool is_static() const { return dt == 0.0; }
};

/// The motion of a recording: measured rates where logged, else derivatives of the pose by
/// `derivative` (of the orientation by quaternions, free of gimbal lock). A static list is at rest.
Motion motion_of(const Recording& recording, const ToolModel& model,
                 const DerivativeSpec& derivative);

/// The exact motion of a trajectory, without numerical differentiation.
Motion motion_of(const Trajectory& trajectory, const ToolModel& model);

/// t, or the rows in their order where there is none, (T).
Eigen::VectorXd times_of(const Recording& recording);

/// Euler angles of a recording as one continuous branch, (T,3): the logged ones where the log
/// itself is continuous; where it jumps at +-pi, unwrapped onto the branch with a mean in [0, 2
/// pi), so that recordings of a tool that points down share one branch whichever side they begin
/// on.
Eigen::MatrixXd continuous_euler(const Recording& recording);

}  // namespace dcnn
