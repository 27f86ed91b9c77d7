// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/load.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "data/clock.h"
#include "data/held_rows.h"
#include "data/kept_rows.h"
#include "data/known_columns.h"
#include "data/repeated_rows.h"
#include "data/spikes.h"
#include "dcnn/data/file_names.h"
#include "diagnosis/simulated_inertia.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr std::array<const char*, 6> kChannels{"fx", "fy", "fz", "tx", "ty", "tz"};

double first_time(const Recording& r) { return r.has("t") ? r.column("t")(0) : 0.0; }
double last_time(const Recording& r) { return r.has("t") ? r.column("t")(r.samples() - 1) : 0.0; }

std::vector<Recording> read_all(const std::vector<std::filesystem::path>& paths,
                                const DiagnosisRequest& request, const Case& study) {
  std::vector<Recording> recordings;
  ReadOptions read = request.read;
  read.static_list = true;
  if (request.simulator) read.payload.rpy = study.simulator.model.sensor_rotation_rpy;
  for (const auto& path : paths) {
    Recording& recording = recordings.emplace_back(read_recording(path, read, System()));
    name_and_cut(request, path, recording);
    if (recording.dt > 0.0) {
      drop_short_stretches(recording, study.derivative.fewest_rows(recording.dt));
    }
    const auto& zeroed = request.zeroed;
    if (std::find(zeroed.begin(), zeroed.end(), path) != zeroed.end()) {
      recordings.back().zeroed = true;
    }
  }
  std::stable_sort(recordings.begin(), recordings.end(),
                   [](const auto& a, const auto& b) { return first_time(a) < first_time(b); });
  return recordings;
}

/// Somebody else's prediction of the channels that are measured.
Wrench simulated_columns(const Recording& recording, const Case& study) {
  Wrench base{Eigen::MatrixXd::Zero(recording.samples(), 3),
              Eigen::MatrixXd::Zero(study.has_torque() ? recording.samples() : 0, 3)};
  for (std::size_t j = 0; j < study.channels.size(); ++j) {
    const std::string column = study.targets[j] + "_sim";
    require(recording.has(column), Exit::kData, recording.name, ": column '", column,
            "' is missing; give --sim, or what your simulator predicts for every measured target");
    const int channel = study.channels[j];
    (channel < 3 ? base.force.col(channel) : base.torque.col(channel - 3)) =
        recording.column(column);
  }
  return base;
}

/// Which wrench components every recording measures, and the simulator predicts.
void choose_channels(const std::vector<Recording>& recordings, const DiagnosisRequest& request,
                     Case& study) {
  const bool torque = !request.simulator || study.simulator.model.inertia.has_value();
  for (int channel = 0; channel < (torque ? 6 : 3); ++channel) {
    const std::string name = kChannels[static_cast<std::size_t>(channel)];
    const bool measured = std::all_of(recordings.begin(), recordings.end(),
                                      [&](const Recording& r) { return r.has(name); });
    const bool simulated = request.simulator || recordings.front().has(name + "_sim");
    if (!measured || !simulated) continue;
    study.channels.push_back(channel);
    study.targets.push_back(name);
    study.units.push_back(channel < 3 ? "N" : "N*m");
  }
  require(!study.channels.empty(), Exit::kData, recordings.front().name,
          ": no force that is both measured and simulated; give columns fx,fy,fz and --sim or "
          "fx_sim,fy_sim,fz_sim");
}

Log make_log(Recording recording, const Case& study, bool columns) {
  Log log;
  if (columns) log.base = simulated_columns(recording, study);
  log.measured = recording.block(study.targets);
  log.zeroed = recording.zeroed;
  log.recording = std::move(recording);
  log.motion = wrist_motion(log, study);
  return log;
}

/// Of a model that needs an acceleration, where recordings with a clock tell none.
void leave_out_inertial_force(const std::vector<Recording*>& recordings, ToolModel& model) {
  const auto tells = [](const Recording* r) {
    return r->dt == 0.0 || r->has_all({"x", "y", "z"}) || r->has_all({"ax", "ay", "az"});
  };
  if (model.inertial == ToolModel::Inertial::kNone ||
      std::all_of(recordings.begin(), recordings.end(), tells)) {
    return;
  }
  model.inertial = ToolModel::Inertial::kNone;
  for (Recording* recording : recordings) {
    recording->notes.push_back(
        "the recordings have no x,y,z or ax,ay,az: the tool's inertial force is left out");
  }
}

/// The columns of a wrist recording that laws may follow.
std::vector<std::string> wrist_signals(const DiagnosisRequest& request,
                                       const std::vector<Recording>& recordings) {
  std::vector<std::string> names = request.signals;
  for (const std::string& name : names) {
    for (const Recording& recording : recordings) {
      require(recording.has(name), Exit::kData, recording.name, ":1: column '", name,
              "' of --signals is missing; log it, or leave it out");
    }
  }
  const bool asked = std::find(names.begin(), names.end(), "temperature") != names.end();
  if (!asked) names.emplace_back("temperature");
  return names;
}

/// Tells of columns that vary and that nothing looks at.
void note_unused_columns(const DiagnosisRequest& request, Recording& recording) {
  std::vector<std::string> used{"t",     "x",  "y",  "z",  "alpha", "beta",
                                "gamma", "qw", "qx", "qy", "qz"};
  for (const auto& list : {known_columns(System{}), request.signals}) {
    used.insert(used.end(), list.begin(), list.end());
  }
  std::string unused, first;
  for (const std::string& name : recording.table.columns) {
    if (std::find(used.begin(), used.end(), name) != used.end()) continue;
    const Eigen::VectorXd values = recording.column(name);
    if (!values.allFinite() || values.minCoeff() == values.maxCoeff()) continue;
    if (first.empty()) first = name;
    unused += (unused.empty() ? "" : ", ") + name;
  }
  if (first.empty()) return;
  recording.notes.push_back("not looked at: " + unused + "; --signals " + first +
                            " lets laws follow such a column");
}

}  // namespace

std::vector<Case::Driver> drivers_of(const std::vector<std::string>& names,
                                     const std::vector<Recording>& fit,
                                     const std::vector<Recording>& holdout) {
  constexpr double kVaries = 1e-9;  // of its size: what rounding makes
  std::vector<Case::Driver> drivers;
  for (const std::string& name : names) {
    const auto logged = [&](const Recording& r) {
      return r.has(name) && r.column(name).allFinite();
    };
    if (!std::all_of(fit.begin(), fit.end(), logged) ||
        !std::all_of(holdout.begin(), holdout.end(), logged)) {
      continue;
    }
    double low = kInfinity, high = -kInfinity;
    for (const Recording& r : fit) {
      low = std::min(low, r.column(name).minCoeff());
      high = std::max(high, r.column(name).maxCoeff());
    }
    const double size = std::max(std::abs(low), std::abs(high));
    if (high - low > kVaries * size) drivers.push_back({name, low, high});
  }
  return drivers;
}

void name_and_cut(const DiagnosisRequest& request, const std::filesystem::path& path,
                  Recording& recording) {
  std::vector<std::filesystem::path> all = request.fit;
  all.insert(all.end(), request.holdout.begin(), request.holdout.end());
  recording.name = distinct_name(path, all);
  if (!recording.has("t") || recording.dt <= 0.0) return;
  const Eigen::VectorXd t = recording.column("t").array() + recording.clock_origin;
  std::vector<bool> kept(static_cast<std::size_t>(t.size()), true);
  for (const DiagnosisRequest::NoReading& none : request.no_readings) {
    if (none.recording != path) continue;
    for (Index i = 0; i < t.size(); ++i) {
      if (t(i) >= none.begin_s && t(i) <= none.end_s) kept[static_cast<std::size_t>(i)] = false;
    }
    recording.notes.push_back(none.channel + " is frozen from " + brief(none.begin_s) + " to " +
                              brief(none.end_s) + " s: these rows are left out");
  }
  if (std::find(kept.begin(), kept.end(), false) == kept.end()) return;
  lose_rows(recording, kept);
}

std::vector<Recording*> with_usable_rows(std::vector<Recording>& fit,
                                         std::vector<Recording>& holdout, const System& system,
                                         const std::vector<std::string>& targets) {
  std::vector<Recording*> both;
  for (auto* list : {&fit, &holdout}) {
    for (Recording& recording : *list) both.push_back(&recording);
  }
  keep_new_rows(both, system);
  for (Recording* recording : both) {
    leave_out_repeats(*recording, targets);
    mend_spikes(*recording, targets);
  }
  return both;
}

void check_rates(const std::vector<Recording>& recordings) {
  constexpr double kTolerance = 0.01;
  const Recording& first = recordings.front();
  for (const Recording& r : recordings) {
    require((r.dt == 0.0) == (first.dt == 0.0), Exit::kData, r.name, ": ",
            r.dt == 0.0 ? "is a list of poses without t beside "
                        : "has a clock beside the list of poses ",
            first.name, "; diagnose them apart");
    require(r.has("t") == first.has("t"), Exit::kData, r.name,
            ": one list of poses has times and the other none; diagnose them apart");
    require(std::abs(r.dt - first.dt) <= kTolerance * first.dt, Exit::kData, r.name, ": has ",
            1.0 / r.dt, " Hz beside ", 1.0 / first.dt, " Hz of ", first.name, "; use --resample ",
            std::min(1.0 / r.dt, 1.0 / first.dt));
  }
}

void set_clock(const DiagnosisRequest& request, const std::vector<Recording>& recordings,
               Case& study) {
  std::vector<std::pair<double, double>> spans;
  for (const Recording& r : recordings) {
    spans.emplace_back(first_time(r), last_time(r));
    study.end_of_clock = std::max(study.end_of_clock, spans.back().second);
  }
  std::sort(spans.begin(), spans.end());
  const auto overlapping = [](const auto& a, const auto& b) { return b.first < a.second; };
  const bool overlap = std::adjacent_find(spans.begin(), spans.end(), overlapping) != spans.end();
  study.shared_clock = request.shared_clock.value_or(!overlap);
  require(!(study.shared_clock && overlap), Exit::kData, recordings.front().name,
          ": its time overlaps another recording's; use --clock own");
}

LoadedCase load_wrist(const DiagnosisRequest& request) {
  LoadedCase loaded;
  Case& study = loaded.fit;
  study.without = request.without;
  if (request.simulator) {
    study.simulator = read_simulator(*request.simulator);
    study.simulator.model = changed_tool(study.simulator.model, study.simulator.effects);
    std::erase_if(study.simulator.effects, [](const EffectSpec& effect) {
      return find_effect(effect.effect)->stage == Stage::kTool;
    });
  } else {
    study.own_tool = false;
    study.simulator.model.inertia = Eigen::Matrix3d::Zero();
  }
  auto fit = read_all(request.fit, request, study),
       holdout = read_all(request.holdout, request, study);
  std::vector<std::string> targets(kChannels.begin(), kChannels.end());
  std::erase_if(targets, [&](const std::string& name) { return !fit.front().has(name); });
  const std::vector<Recording*> both = with_usable_rows(fit, holdout, System(), targets);
  leave_out_inertial_force(both, study.simulator.model);
  std::vector<Recording> all = fit;
  all.insert(all.end(), holdout.begin(), holdout.end());
  check_rates(all);
  choose_channels(all, request, study);
  if (!study.has_torque()) study.simulator.model.inertia.reset();
  set_clock(request, all, study);
  study.drivers = drivers_of(wrist_signals(request, all), fit, holdout);
  note_unused_columns(request, fit.front());
  if (request.simulator && fit.front().has(targets.front() + "_sim")) {
    fit.front().notes.push_back("column " + targets.front() +
                                "_sim and its companions are not looked at: --sim is the "
                                "simulator; leave it out to compare with them");
  }
  loaded.holdout = study;
  for (auto& r : fit) study.logs.push_back(make_log(std::move(r), study, !request.simulator));
  study.has_inertia = study.own_tool || simulates_inertia(study.logs);
  for (auto& r : holdout) {
    loaded.holdout.logs.push_back(make_log(std::move(r), loaded.holdout, !request.simulator));
    // Where every fitted recording was zeroed none of them tells the offset of another.
    loaded.holdout.logs.back().zeroed |= has_own_offsets(study);
  }
  return loaded;
}

}  // namespace dcnn
