// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/recording.h"

#include <algorithm>
#include <cmath>

#include "data/clock.h"
#include "data/even_clock.h"
#include "data/known_columns.h"
#include "data/limits.h"
#include "data/near_names.h"
#include "data/pose_checks.h"
#include "dcnn/data/filter.h"
#include "dcnn/data/table_reader.h"

namespace dcnn {
namespace {

using Names = std::vector<std::string>;

const Names kForce = {"fx", "fy", "fz"}, kTorque = {"tx", "ty", "tz"};

Index find(const Table& table, const std::string& name) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  return found == table.columns.end() ? -1 : found - table.columns.begin();
}

bool has_any(const Recording& recording, const Names& columns) {
  return std::any_of(columns.begin(), columns.end(),
                     [&](const std::string& name) { return recording.has(name); });
}

/// A vector is there with all its components or not at all.
bool has_whole(const Recording& recording, const Names& columns, const std::string& file) {
  if (!has_any(recording, columns)) return false;
  for (const std::string& name : columns) {
    require(recording.has(name), Exit::kData, file, ":1: column '", name,
            "' is missing, and others of the vector are there; log all of them or none");
  }
  return true;
}

Index place_in(const Recording& recording, const std::string& column) {
  const Index k = find(recording.table, column);
  require(k >= 0, Exit::kData, recording.name, ":1: column '", column,
          "' is missing; add it to the log");
  return k;
}

void require_column(const Recording& recording, const std::string& name, const std::string& axis,
                    const std::string& file) {
  require(name.empty() || recording.has(name), Exit::kData, file, ":1: column '", name,
          "' of axis '", axis, "' is missing; add it or correct the system description");
}

void check_wrist_columns(const Recording& recording, const ReadOptions& options,
                         const std::string& file) {
  const bool quaternion = has_whole(recording, {"qw", "qx", "qy", "qz"}, file);
  const bool euler = has_whole(recording, {"alpha", "beta", "gamma"}, file);
  require(
      quaternion || euler, Exit::kData, file,
      ":1: no orientation; log qw,qx,qy,qz or alpha,beta,gamma, or name the columns with --system");
  const bool force =
      options.part_of_wrench ? has_any(recording, kForce) : has_whole(recording, kForce, file);
  const bool torque =
      options.part_of_wrench ? has_any(recording, kTorque) : has_whole(recording, kTorque, file);
  require(force || torque || options.motion_only, Exit::kData, file,
          ":1: no measured force; log fx,fy,fz or tx,ty,tz");
  for (const Names& optional :
       {Names{"x", "y", "z"}, Names{"vx", "vy", "vz"}, Names{"wx", "wy", "wz"},
        Names{"ax", "ay", "az"}, Names{"dwx", "dwy", "dwz"}}) {
    has_whole(recording, optional, file);
  }
}

void check_axis_columns(const Recording& recording, const System& system, bool motion_only,
                        const std::string& file) {
  for (const Axis& axis : system.axes) {
    if (!motion_only) require_column(recording, axis.measured, axis.name, file);
    for (const std::string& name :
         {axis.position, axis.velocity, axis.acceleration, axis.simulated}) {
      require_column(recording, name, axis.name, file);
    }
    for (const std::string& name : axis.signals) require_column(recording, name, axis.name, file);
  }
}

void scale_columns(Recording& recording, const Names& columns, double factor) {
  for (const std::string& name : columns) {
    if (recording.has(name)) recording.set(name, factor * recording.column(name));
  }
}

/// Text becomes SI here and nowhere else.
void convert_units(Recording& recording, const ReadOptions& options) {
  std::ostringstream note;
  if (options.position_unit != 1.0) {
    scale_columns(recording, {"x", "y", "z", "vx", "vy", "vz", "ax", "ay", "az"},
                  options.position_unit);
    note << "positions and linear rates converted: 1 unit = " << options.position_unit << " m";
    recording.notes.push_back(note.str());
  }
  if (options.angle_unit != 1.0) {
    scale_columns(recording, {"alpha", "beta", "gamma", "wx", "wy", "wz", "dwx", "dwy", "dwz"},
                  options.angle_unit);
    note.str("");
    note << "angles and angular rates converted: 1 unit = " << options.angle_unit << " rad";
    recording.notes.push_back(note.str());
  }
  if (options.force_sign != 1.0) {
    scale_columns(recording,
                  {"fx", "fy", "fz", "tx", "ty", "tz", "fx_sim", "fy_sim", "fz_sim", "tx_sim",
                   "ty_sim", "tz_sim"},
                  options.force_sign);
    recording.notes.push_back("sign of forces and torques (measured and simulated) turned");
  }
}

/// Squares and products of what is measured stay far from overflow.
void check_magnitudes(const Recording& recording, const System& system, const std::string& file) {
  const double most = system.kind == System::Kind::kWrist ? kMostMeasured : kMostOfAxis;
  for (const std::string& name : known_columns(system)) {
    if (!recording.has(name)) continue;
    const Eigen::VectorXd values = recording.column(name);
    Index row = 0;
    if (values.size() == 0 || values.cwiseAbs().maxCoeff(&row) <= most) continue;
    fail(Exit::kData, file, ":", row + 2, ": column '", name, "' is ", values[row],
         ", beyond any sensor; repair the log or correct its unit");
  }
}

void check_options(const ReadOptions& options, const System& system) {
  const bool plain = options.position_unit == 1.0 && options.angle_unit == 1.0 &&
                     options.force_sign == 1.0 && options.payload.mass == 0.0;
  require(plain || system.kind == System::Kind::kWrist, Exit::kUsage,
          "--position-unit, --angle-unit, --force-sign and --payload are for wrist recordings; "
          "give the axis a 'scale' in the system description");
}

Names smooth_columns(const System& system) {
  if (system.kind == System::Kind::kWrist) {
    return {"x", "y", "z", "alpha", "beta", "gamma", "qw", "qx", "qy", "qz"};
  }
  Names names;
  for (const Axis& axis : system.axes) names.push_back(axis.position);
  return names;
}

}  // namespace

Names known_columns(const System& system) {
  if (system.kind == System::Kind::kWrist) {
    return {"fx",     "fy",     "fz",     "tx",  "ty",  "tz",  "fx_sim",     "fy_sim", "fz_sim",
            "tx_sim", "ty_sim", "tz_sim", "vx",  "vy",  "vz",  "wx",         "wy",     "wz",
            "ax",     "ay",     "az",     "dwx", "dwy", "dwz", "temperature"};
  }
  Names names;
  for (const Axis& axis : system.axes) {
    for (const auto& name :
         {axis.measured, axis.position, axis.velocity, axis.acceleration, axis.simulated}) {
      names.push_back(name);
    }
    names.insert(names.end(), axis.signals.begin(), axis.signals.end());
  }
  return names;
}

bool Recording::has(const std::string& column) const { return find(table, column) >= 0; }

bool Recording::has_all(const Names& columns) const {
  return std::all_of(columns.begin(), columns.end(),
                     [&](const std::string& column_name) { return has(column_name); });
}

Eigen::VectorXd Recording::column(const std::string& column_name) const {
  return table.values.col(place_in(*this, column_name));
}

Eigen::MatrixXd Recording::block(const Names& columns) const {
  Eigen::MatrixXd out(samples(), static_cast<Index>(columns.size()));
  for_each_piece(out.cols(), [&](Index k) {
    out.col(k) = table.values.col(place_in(*this, columns[static_cast<std::size_t>(k)]));
  });
  return out;
}

void Recording::set(const std::string& column_name, const Eigen::VectorXd& values) {
  Index k = find(table, column_name);
  if (k < 0) {
    k = static_cast<Index>(table.columns.size());
    table.columns.push_back(column_name);
    table.values.conservativeResize(values.size(), k + 1);
  }
  table.values.col(k) = values;
}

Recording read_recording(const std::filesystem::path& path, const ReadOptions& options,
                         const System& system) {
  check_options(options, system);
  return make_recording(read_table(path), path, options, system);
}

Recording make_recording(SourceTable source, const std::filesystem::path& path,
                         const ReadOptions& options, const System& system) {
  const std::string file = path.string();
  check_options(options, system);
  Recording recording;
  recording.name = path.filename().string();
  recording.table = std::move(source.table);
  recording.notes = std::move(source.notes);
  recording.zeroed = source.zeroed;
  const bool wrist = system.kind == System::Kind::kWrist;
  refuse_near_names(recording.table.columns, system, file);
  require(recording.has("t") || options.static_list, Exit::kData, file,
          ":1: column 't' is missing; log the time in seconds: a list of poses at rest, which has "
          "none, is not enough here",
          wrist ? "" : "; dcnn-identify takes one of an arm");
  if (wrist) check_wrist_columns(recording, options, file);
  if (!wrist) check_axis_columns(recording, system, options.motion_only, file);
  set_clock(recording, file, wrist && options.static_list);
  convert_units(recording, options);
  check_magnitudes(recording, system, file);
  if (wrist) check_pose(recording, file);
  const bool asked = options.resample || system.resample_hz > 0.0;
  if (asked && recording.dt > 0.0) {
    const double hz = options.resample_hz > 0.0 ? options.resample_hz : system.resample_hz;
    if (wrist) make_continuous(recording);
    resample(recording, hz, smooth_columns(system));
  }
  check_regular(recording, file);
  drop_short_stretches(recording);
  if (wrist) normalise_quaternions(recording);
  if (!asked && recording.dt > 0.0) {
    Recording even = recording;
    if (wrist) make_continuous(even);
    if (put_on_even_clock(even, smooth_columns(system))) recording = std::move(even);
  }
  if (options.payload.mass > 0.0) add_weight(options.payload, recording);
  return recording;
}

Targets find_targets(const Recording& recording, const System& system) {
  Targets targets;
  if (system.kind == System::Kind::kAxes) {
    for (const Axis& axis : system.axes) {
      targets.names.push_back(axis.measured);
      targets.units.push_back(axis.unit);
    }
    return targets;
  }
  const auto add = [&](const Names& columns, const char* unit) {
    if (!recording.has_all(columns)) return;
    targets.names.insert(targets.names.end(), columns.begin(), columns.end());
    targets.units.insert(targets.units.end(), columns.size(), unit);
  };
  add(kForce, "N");
  add(kTorque, "N*m");
  return targets;
}

Eigen::MatrixXd measured(const Recording& recording, const Targets& targets, const System& system,
                         bool filtered) {
  Eigen::MatrixXd values = recording.block(targets.names);
  for (const Axis& axis : system.axes) {
    for (std::size_t k = 0; k < targets.names.size(); ++k) {
      if (targets.names[k] == axis.measured) values.col(static_cast<Index>(k)) *= axis.scale;
    }
  }
  return filtered ? low_pass(values, recording, system.lowpass_hz) : values;
}

}  // namespace dcnn
