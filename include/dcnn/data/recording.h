// SPDX-License-Identifier: Apache-2.0
// A recording: named columns on one clock. A simulated and a measured one are the same type.
#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/core/parallel.h"
#include "dcnn/data/csv.h"
#include "dcnn/data/system.h"
#include "dcnn/data/table_reader.h"

namespace dcnn {

/// Columns of a pose.
inline const std::vector<std::string> kPosition = {"x", "y", "z"};
inline const std::vector<std::string> kEuler = {"alpha", "beta", "gamma"};
inline const std::vector<std::string> kQuaternion = {"qw", "qx", "qy", "qz"};

/// Rows [begin, end) without a gap in time: no derivative, window or noise crosses its ends.
struct Segment {
  Index begin = 0, end = 0;
  Index size() const { return end - begin; }
};

/// A body whose weight a robot's controller has subtracted from the force.
struct Payload {
  double mass = 0.0;                              ///< kg; 0: nothing was subtracted
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< m, in S
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();  ///< (rx, ry, rz): R_ES = Rz·Ry·Rx
};

/// How a file is turned into SI units on a regular clock.
struct ReadOptions {
  double position_unit = 1.0;   ///< metres per unit in the file (0.001: millimetres)
  double angle_unit = 1.0;      ///< radians per unit in the file (pi/180: degrees)
  double force_sign = 1.0;      ///< -1 where the log holds the reaction
  Payload payload;              ///< whose weight is added back
  bool resample = false;        ///< put an irregular clock on a regular one
  double resample_hz = 0.0;     ///< 0: the recording's own median rate
  bool static_list = false;     ///< accept a list of poses without time
  bool motion_only = false;     ///< nothing measured is needed: the log is to be predicted
  bool part_of_wrench = false;  ///< a sensor of fewer than three forces, or torques, is read
};

struct Recording {
  std::string name;  ///< the file's name without its folder
  Table table;       ///< SI units; column t starts at the file's own clock minus clock_origin
  double dt = 0.0;   ///< s, median step; 0 for a list of poses at rest
  double clock_origin = 0.0;       ///< s, subtracted from t where the smallest t exceeds 1e6 s
  std::vector<Segment> segments;   ///< in order, covering every row
  bool zeroed = false;             ///< the sensor was set to zero for it: its offset is its own
  std::vector<std::string> notes;  ///< conversions, resampling, gaps: for every report
  /// Of rows that linear interpolation made: autocovariance of what it makes of white noise of
  /// variance 1, at lags of 0, 1, … rows; empty where rows are as logged.
  std::vector<double> interpolated = {};

  Index samples() const { return table.values.rows(); }
  bool has(const std::string& column) const;
  /// All of the named columns are there.
  bool has_all(const std::vector<std::string>& columns) const;
  /// (T); an Error(kData) that names the file where the column is missing.
  Eigen::VectorXd column(const std::string& name) const;
  /// (T, columns.size()).
  Eigen::MatrixXd block(const std::vector<std::string>& columns) const;
  /// Adds a column or replaces it.
  void set(const std::string& name, const Eigen::VectorXd& values);
};

/// Reads, checks and converts one recording. `system` names the columns that must be there: for
/// `wrist` time, an orientation and a force; for `axes` those of the description. All faults are
/// Error(kData).
Recording read_recording(const std::filesystem::path& path, const ReadOptions& options,
                         const System& system);

/// The same from a table that is in memory; `file` names it in errors.
Recording make_recording(SourceTable table, const std::filesystem::path& file,
                         const ReadOptions& options, const System& system);

/// Adds the weight of a payload to the measured force and torque, m R^T g and c x m R^T g with
/// g = (0, 0, -9.80665) m/s²: what the sensor read before the controller compensated it.
void add_weight(const Payload& payload, Recording& recording);

/// The measured quantities to predict: for `wrist` fx,fy,fz and tx,ty,tz where present.
struct Targets {
  std::vector<std::string> names, units;
};
Targets find_targets(const Recording& recording, const System& system);

/// (T, targets): measured values times the axis' scale, zero-phase low-passed where the system says
/// so
/// (`filtered` false leaves that out).
Eigen::MatrixXd measured(const Recording& recording, const Targets& targets, const System& system,
                         bool filtered = true);

}  // namespace dcnn
