// SPDX-License-Identifier: Apache-2.0
#include "data/held_rows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "data/kept_rows.h"
#include "data/spikes.h"
#include "dcnn/data/filter.h"

namespace dcnn {
namespace {

constexpr Index kLongest = 64;   // rows
constexpr Index kFewest = 20;    // changes
constexpr double kShare = 0.95;  // of the distances; lost rows break some

/// Places of all rows on the clock, in steps: rows may be lost in between.
std::vector<Index> places_of(const Recording& recording) {
  const Eigen::VectorXd t = recording.column("t");
  std::vector<Index> places{0};
  for (Index i = 1; i < t.size(); ++i) {
    const auto steps = static_cast<Index>(std::llround((t(i) - t(i - 1)) / recording.dt));
    places.push_back(places.back() + std::max<Index>(1, steps));
  }
  return places;
}

/// Places in a segment at which a value differs from the row before.
std::vector<Index> changes_in(const Eigen::MatrixXd& values, const Segment& segment,
                              const std::vector<Index>& places) {
  std::vector<Index> changes;
  for (Index i = segment.begin + 1; i < segment.end; ++i) {
    if (values.row(i) != values.row(i - 1)) changes.push_back(places[static_cast<std::size_t>(i)]);
  }
  return changes;
}

}  // namespace

bool never_changes(const Eigen::VectorXd& column) { return (column.array() == column[0]).all(); }

Index held_rows(const Recording& recording, const std::vector<std::string>& columns) {
  if (recording.dt <= 0.0 || columns.empty()) return 1;
  const Eigen::MatrixXd values = recording.block(columns);
  const std::vector<Index> places = places_of(recording);
  std::map<Index, Index> distances;
  Index all = 0;
  for (const Segment& segment : recording.segments) {
    const auto changes = changes_in(values, segment, places);
    for (std::size_t k = 1; k < changes.size(); ++k, ++all)
      ++distances[changes[k] - changes[k - 1]];
  }
  if (all < kFewest) return 1;
  for (Index held = kLongest; held > 1; --held) {
    Index multiples = 0;
    for (const auto& [distance, count] : distances) multiples += distance % held == 0 ? count : 0;
    if (static_cast<double>(multiples) >= kShare * static_cast<double>(all)) return held;
  }
  return 1;
}

namespace {

/// Leaves every `every`-th row, at those places at which values held for `held` rows are new.
void keep_every(Recording& recording, const std::vector<std::string>& columns, Index held,
                Index every) {
  const Eigen::MatrixXd values = recording.block(columns);
  const std::vector<Index> places = places_of(recording);
  std::vector<bool> kept(places.size(), false);
  for (const Segment& segment : recording.segments) {
    std::map<Index, Index> phases;
    for (const Index place : changes_in(values, segment, places)) ++phases[place % held];
    const auto most =
        std::max_element(phases.begin(), phases.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    const Index phase = most == phases.end() ? 0 : most->first;
    for (auto row = static_cast<std::size_t>(segment.begin);
         row < static_cast<std::size_t>(segment.end); ++row) {
      kept[row] = places[row] % every == phase;
    }
  }
  keep_rows(recording, kept);
  recording.dt *= static_cast<double>(every);
  recording.notes.push_back(
      "values of " + columns.front() + (columns.size() > 1 ? " and its companions" : "") +
      " are held from row to row: one row in " + std::to_string(every) + " is used");
}

/// Columns that one source of a log writes together.
struct Source {
  std::vector<std::string> columns;
  bool reading = false;  // of a sensor or a simulator; else of the motion
};

/// Of a recording: what is measured, what is simulated, and the motion with all that follows it.
std::vector<Source> sources_of(const Recording& recording, const System& system) {
  const auto add = [&](const std::vector<std::string>& names, Source& to) {
    for (const std::string& name : names) {
      const bool again = std::count(to.columns.begin(), to.columns.end(), name) > 0;
      if (recording.has(name) && !again) to.columns.push_back(name);
    }
  };
  Source measured{{}, true}, simulated{{}, true}, motion;
  if (system.kind == System::Kind::kWrist) {
    add({"fx", "fy", "fz", "tx", "ty", "tz"}, measured);
    add({"fx_sim", "fy_sim", "fz_sim", "tx_sim", "ty_sim", "tz_sim"}, simulated);
    for (const auto& pose : {kPosition, kEuler, kQuaternion}) add(pose, motion);
    add({"vx", "vy", "vz", "wx", "wy", "wz", "ax", "ay", "az", "dwx", "dwy", "dwz"}, motion);
  }
  for (const Axis& axis : system.axes) {
    add({axis.measured}, measured);
    add({axis.simulated}, simulated);
    add({axis.position, axis.velocity, axis.acceleration}, motion);
    add(axis.base, motion);
  }
  std::vector<Source> sources{measured, simulated, motion};
  std::erase_if(sources, [](const Source& source) { return source.columns.empty(); });
  require(!sources.empty(), Exit::kData, recording.name, ": has no column that is known here");
  return sources;
}

/// Rows for which each source of a recording holds its values; of one source at least.
struct Holds {
  std::vector<Index> rows;
  std::size_t slowest() const {
    return static_cast<std::size_t>(std::max_element(rows.begin(), rows.end()) - rows.begin());
  }
};

constexpr double kOfNewRate = 0.4;  // below half, for the slope of the low-pass

void average_readings(Recording& recording, const std::vector<Source>& sources, const Holds& holds,
                      Index every) {
  const double hz = kOfNewRate / (static_cast<double>(every) * recording.dt);
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const auto& columns = sources[k].columns;
    if (!sources[k].reading || holds.rows[k] > 1) continue;
    mend_spikes(recording, columns);
    const Eigen::MatrixXd smooth = low_pass(recording.block(columns), recording, hz);
    for (std::size_t j = 0; j < columns.size(); ++j) {
      recording.set(columns[j], smooth.col(static_cast<Index>(j)));
    }
  }
}

}  // namespace

void keep_new_rows(const std::vector<Recording*>& recordings, const System& system) {
  std::vector<std::vector<Source>> sources;
  std::vector<Holds> holds;
  Index every = 1;
  for (const Recording* recording : recordings) {
    Holds& hold = holds.emplace_back();
    for (const Source& source : sources.emplace_back(sources_of(*recording, system))) {
      hold.rows.push_back(held_rows(*recording, source.columns));
    }
    every = std::lcm(every, hold.rows[hold.slowest()]);
  }
  const bool enough = std::all_of(recordings.begin(), recordings.end(), [&](const Recording* r) {
    const double step = static_cast<double>(every) * r->dt;
    return r->samples() >= kFewest * every && system.lowpass_hz * step < kOfNewRate;
  });
  if (every == 1 || every > kLongest || !enough) return;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    average_readings(*recordings[k], sources[k], holds[k], every);
    const std::size_t slowest = holds[k].slowest();
    keep_every(*recordings[k], sources[k][slowest].columns, holds[k].rows[slowest], every);
  }
}

}  // namespace dcnn
