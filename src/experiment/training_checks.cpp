// SPDX-License-Identifier: Apache-2.0
#include "experiment/training_checks.h"

#include <algorithm>
#include <cmath>

#include "data/held_rows.h"

namespace dcnn {
namespace {

/// Measured columns of all recordings, one below the other.
Eigen::MatrixXd all_measured(const std::vector<Recording>& recordings, const Targets& targets) {
  Index rows = 0;
  for (const Recording& r : recordings) rows += r.samples();
  Eigen::MatrixXd all(rows, static_cast<Index>(targets.names.size()));
  rows = 0;
  for (const Recording& r : recordings) {
    all.middleRows(rows, r.samples()) = r.block(targets.names);
    rows += r.samples();
  }
  return all;
}

void check_measured(const std::vector<Recording>& recordings, const Targets& targets,
                    const TrainingObserver& observer) {
  const Eigen::MatrixXd measured = all_measured(recordings, targets);
  std::vector<std::string> constant;
  for (Index j = 0; j < measured.cols(); ++j) {
    if (!never_changes(measured.col(j))) continue;
    std::ostringstream words;
    words << targets.names[static_cast<std::size_t>(j)] << " = " << measured(0, j);
    constant.push_back(words.str());
  }
  require(constant.size() < targets.names.size(), Exit::kData, recordings.front().name,
          ": every measured column is constant (", constant.empty() ? "" : constant.front(),
          " in all rows), so there is nothing to learn; is the sensor connected and on?");
  for (const std::string& words : constant) {
    if (observer.note) {
      observer.note("constant: " + words + " in all training rows; a dead channel?");
    }
  }
}

/// The columns that features are made of; of a wrist, the pose first.
std::vector<std::string> motion_columns(const Recording& recording, const System& system,
                                        bool rates) {
  std::vector<std::string> names;
  if (system.kind == System::Kind::kAxes) {
    for (const Axis& axis : system.axes) {
      names.push_back(axis.position);
      if (!rates) continue;
      names.insert(names.end(), {axis.velocity, axis.acceleration});
      names.insert(names.end(), axis.signals.begin(), axis.signals.end());
    }
  } else {
    names = kPosition;
    const auto& angles = recording.has_all(kQuaternion) ? kQuaternion : kEuler;
    names.insert(names.end(), angles.begin(), angles.end());
    if (rates) {
      names.insert(names.end(),
                   {"vx", "vy", "vz", "wx", "wy", "wz", "ax", "ay", "az", "dwx", "dwy", "dwz"});
    }
  }
  std::erase_if(names, [&](const std::string& name) { return !recording.has(name); });
  return names;
}

bool any_varies(const std::vector<Recording>& recordings, const System& system) {
  for (const Recording& r : recordings) {
    for (const std::string& name : motion_columns(r, system, true)) {
      const double first = recordings.front().column(name)(0);
      if ((r.column(name).array() != first).any()) return true;
    }
  }
  return false;
}

/// Von Neumann's ratio: of the mean squared difference of neighbours to the variance. 2 is the
/// expectation for white noise, whose deviation is below 2/sqrt(n); a motion that is sampled at all
/// has less than half of that.
bool moves(const Eigen::VectorXd& x) {
  const Index n = x.size();
  const double variance = (x.array() - x.mean()).square().mean();
  if (n < 3 || !(variance > 0.0)) return false;
  return (x.tail(n - 1) - x.head(n - 1)).squaredNorm() / static_cast<double>(n - 1) < variance;
}

bool any_moves(const std::vector<Recording>& recordings, const System& system) {
  for (const Recording& r : recordings) {
    const auto names = motion_columns(r, system, false);
    if (r.dt <= 0.0 || names.empty()) return true;  // a list of poses has no neighbours in time
    for (const std::string& name : names) {
      if (moves(r.column(name))) return true;
    }
  }
  return false;
}

}  // namespace

void check_training(const std::vector<Recording>& recordings, const Targets& targets,
                    const System& system, const TrainingObserver& observer) {
  check_measured(recordings, targets, observer);
  require(any_varies(recordings, system), Exit::kData, recordings.front().name,
          ": nothing moves: pose and rates are constant in all rows; record the machine in motion");
  if (observer.note && !any_moves(recordings, system)) {
    observer.note(recordings.front().name +
                  ": nothing moves beyond the noise of the pose; what is learned holds for this "
                  "pose alone");
  }
}

bool has_time(const Table& table) {
  return std::find(table.columns.begin(), table.columns.end(), "t") != table.columns.end();
}

}  // namespace dcnn
