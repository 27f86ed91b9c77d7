// SPDX-License-Identifier: Apache-2.0
#include "dcnn/identification/identify.h"

#include <cmath>

#include "core/elementary.h"
#include "dcnn/core/number.h"
#include "dcnn/data/rotation.h"
#include "identification/estimates.h"
#include "identification/upright.h"
#include "physics/foreign_force.h"

namespace dcnn {
namespace {

using identification::find_estimate;
using identification::WristFit;
using identification::WristLog;
using identification::WristState;

constexpr int kDraws = 4000;        // 2.5 % quantiles to some 4 % of a deviation
constexpr double kSmallest = 0.03;  // m: radius of gyration of what is taken for a tool's least
constexpr double kOtherMounting = 20.0 * M_PI / 180.0;  // no assembly tolerance

Eigen::Matrix3d least_inertia(double mass, const Eigen::Vector3d& com) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  return mass * ((com.squaredNorm() + kSmallest * kSmallest) * one - com * com.transpose());
}

bool all_shown(const std::vector<IdentifiedNumber>& estimates, const std::string& stem) {
  for (const IdentifiedNumber& e : estimates) {
    if (e.name.starts_with(stem) && !e.shown) return false;
  }
  return true;
}

ToolModel model_of(const WristState& point, const std::vector<WristLog>& logs,
                   const std::vector<IdentifiedNumber>& estimates, bool torque) {
  ToolModel model;
  model.mass = point.mass;
  const Eigen::Vector3d com = point.R_SE * point.h / point.mass;
  for (Index i = 0; i < 3; ++i) {
    const auto* e = find_estimate(estimates, std::string("com_") + "xyz"[i] + "_m");
    model.com[i] = e->shown ? com[i] : 0.0;
  }
  if (torque) {
    const bool shown = all_shown(estimates, "inertia_");
    model.inertia = shown ? Eigen::Matrix3d(point.R_SE * point.inertia * point.R_SE.transpose())
                          : least_inertia(model.mass, model.com);
  }
  model.bias = point.bias;
  model.bias_torque = torque ? point.bias_torque : Eigen::Vector3d::Zero();
  model.sensor_rotation_rpy = euler_from_rotation(point.R_SE.transpose()).reverse();
  for (const WristLog& log : logs) {
    if (log.at_rest) continue;
    model.sample_rate_hz = 1.0 / log.recording.dt;
    if (!log.accelerated) model.inertial = ToolModel::Inertial::kNone;
  }
  return model;
}

/// (channels) about the mean of each log.
Eigen::VectorXd measured_rms(const WristFit& fit) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(fit.layout.channels());
  double rows = 0.0;
  for (const auto& columns : fit.columns) {
    const Eigen::MatrixXd centred = columns.y.rowwise() - columns.y.colwise().mean();
    squares += centred.colwise().squaredNorm().transpose();
    rows += static_cast<double>(columns.rows());
  }
  return (squares / std::max(rows, 1.0)).cwiseSqrt();
}

void note_foreign_force(ToolIdentification& result) {
  const std::string note = foreign_force_note(
      foreign_share(result.residual_rms.head(3).squaredNorm(), 0.0,
                    result.measured_rms.head(3).squaredNorm()),
      "something was touched, the weight is subtracted already (--payload KG adds it back), or "
      "force and pose do not belong together; do not use these numbers before dcnn-check knows "
      "which");
  if (!note.empty()) result.notes.push_back(note);
}

/// Gravity of the base as it is logged, where another frame was upright.
void set_vertical(const Eigen::Matrix3d& turn, ToolIdentification& result) {
  result.model.gravity = turn.transpose() * result.model.gravity;
  const Eigen::Vector3d down = result.model.gravity.normalized();
  char line[200];
  std::snprintf(
      line, sizeof line,
      "the base is not upright: gravity points along (%.2f, %.2f, %.2f) of its axes, %.0f "
      "degrees from -z (a robot on a wall or a ceiling)",
      down.x(), down.y(), down.z(), elementary::acos(-down.z()) * 180.0 / M_PI);
  result.notes.push_back(line);
}

void add_notes(const std::vector<WristLog>& logs, const WristState& point, bool mounting_estimated,
               ToolIdentification& result) {
  for (const WristLog& log : logs) {
    const std::string& name = log.recording.name;
    for (const auto& note : log.recording.notes) result.notes.push_back(name + ": " + note);
    if (log.at_rest) result.notes.push_back(name + ": a list of poses at rest");
    if (!log.at_rest && !log.accelerated) {
      result.notes.push_back(name +
                             ": no position is logged: the weight alone is fitted, and what "
                             "accelerations add is taken for noise");
    }
  }
  const double angle = Eigen::AngleAxisd(point.R_SE).angle();
  if (mounting_estimated && angle > kOtherMounting) {
    char line[200];
    std::snprintf(
        line, sizeof line,
        "the mounting is turned by %.0f degrees against the pose frame; if it is not, check "
        "axes and signs: --mounting 0 0 0, --force-sign -1",
        angle * 180.0 / M_PI);
    result.notes.push_back(line);
  }
}

}  // namespace

std::vector<std::string> assumed(const ToolIdentification& identification) {
  std::vector<std::string> keys;
  for (const auto& [stem, key] : {std::pair("mass_", "mass_kg"), std::pair("com_", "com_m"),
                                  std::pair("inertia_", "inertia_kgm2")}) {
    if (!all_shown(identification.parameters, stem)) keys.emplace_back(key);
  }
  return keys;
}

/// A motion within the band B tells two independent readings of each channel per cycle of it.
void require_enough(const std::vector<WristLog>& logs, const WristFit& fit) {
  constexpr double kFewest = 5.0;  // readings for each number: intervals hold for many
  double seconds = 0.0, readings = 0.0, band = 0.0;
  for (const WristLog& log : logs) {
    if (log.at_rest) return;  // each pose is one, of a noise that the others tell
    const double lasting = static_cast<double>(log.kept.size()) / std::max(1e-9, log.rate_hz());
    seconds += lasting;
    readings += 2.0 * log.cutoff_hz * lasting;
    band = std::max(band, log.cutoff_hz);
  }
  const double wanted =
      kFewest * static_cast<double>(fit.layout.size()) / static_cast<double>(fit.layout.channels());
  require(band == 0.0 || readings >= wanted, Exit::kData, logs.front().recording.name,
          ": too short for ", fit.layout.size(), " numbers: ", brief(seconds),
          " s of a motion within ", brief(band), " Hz, without its ends; record at least ",
          brief(wanted / (2.0 * band)), " s");
}

ToolIdentification identify_tool(const IdentifyRequest& request) {
  std::vector<WristLog> logs = identification::read_wrist_logs(request.logs, request.read);
  identification::FitOptions options;
  options.laws = request.laws;
  if (request.mounting_rpy) options.R_ES = rotation_from_euler(request.mounting_rpy->reverse());
  const auto turn =
      identification::upright_turn(logs, options.R_ES.value_or(Eigen::Matrix3d::Identity()));
  for (WristLog& log : logs) {
    if (turn) identification::turn_base(*turn, log);
  }
  const WristFit fit = identification::fit_wrist(logs, options);
  require_enough(logs, fit);
  Rng rng({0x6964656e74696679ULL});
  const auto draws = identification::draw_states(fit, kDraws, rng);
  require(!draws.states.empty() && fit.state.mass > 0.0, Exit::kData, logs.front().recording.name,
          ": no positive mass explains the force; the log may hold the reaction: --force-sign -1");
  const bool estimate_is_mode = !draws.constrained && draws.inside > 0.5;
  const WristState point = estimate_is_mode ? fit.state : mean_state(fit, draws);

  ToolIdentification result;
  result.parameters = identification::tool_estimates(fit, point, draws);
  identification::mark_shown(logs, fit, result.parameters);
  result.beside = identification::beside_estimates(logs, fit, point, draws);
  result.model = model_of(point, logs, result.parameters, fit.layout.torque);
  result.constrained = draws.constrained;
  result.possible_share = draws.inside;
  result.residual_rms = fit.residual_rms;
  result.measured_rms = measured_rms(fit);
  result.cutoff_hz.resize(static_cast<Index>(logs.size()));
  for (std::size_t k = 0; k < logs.size(); ++k) {
    result.recordings.push_back(logs[k].recording.name);
    result.cutoff_hz[static_cast<Index>(k)] = logs[k].cutoff_hz;
  }
  result.targets = {"fx", "fy", "fz"};
  result.units = {"N", "N", "N"};
  if (fit.layout.torque) {
    result.targets.insert(result.targets.end(), {"tx", "ty", "tz"});
    result.units.insert(result.units.end(), {"N*m", "N*m", "N*m"});
  }
  if (turn) set_vertical(*turn, result);
  add_notes(logs, point, fit.layout.mounting, result);
  note_foreign_force(result);
  return result;
}

}  // namespace dcnn
