// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/axis_case.h"

#include <algorithm>
#include <cmath>

#include "data/median.h"
#include "dcnn/data/filter.h"
#include "dcnn/physics/axis_machine.h"
#include "diagnosis/axis_sense.h"
#include "diagnosis/axis_units.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/lagging_rates.h"
#include "diagnosis/motion_band.h"
#include "diagnosis/moving.h"
#include "diagnosis/periodograms.h"
#include "diagnosis/position_bins.h"
#include "diagnosis/shared_base.h"

namespace dcnn {
namespace {

constexpr double kBaseTolerance = 1e-3;  // of a column's length that others must leave

std::vector<Recording> read_all(const std::vector<std::filesystem::path>& paths,
                                const DiagnosisRequest& request, const System& system) {
  ReadOptions options = request.read;
  options.static_list = true;
  std::vector<Recording> recordings;
  for (const auto& path : paths) {
    recordings.push_back(read_recording(path, options, system));
    name_and_cut(request, path, recordings.back());
  }
  return recordings;
}

Log make_log(const Recording& recording, const Case& study) {
  const System& system = study.axis->system;
  const Axis& axis = study.axis->axis();
  Targets target;
  target.names = {axis.measured};
  Log log;
  log.recording = recording;
  // The chain knows forces on a tool: what an axis shows it is the reaction to its drive.
  const double sign = -study.axis->sense;
  log.measured = sign * measured(recording, target, system, true);
  if (system.lowpass_hz > 0.0) {
    log.unfiltered = sign * measured(recording, target, system, false);
  }
  return log;
}

/// The description, with the arm that was given beside it; or a corrected simulator.
struct GivenSystem {
  System system;
  std::optional<AxisMachine> machine = std::nullopt;
};
GivenSystem given_system(const DiagnosisRequest& request) {
  Json json = read_json(*request.system, Exit::kData);
  const std::string where = request.system->string();
  if (is_axis_machine(json)) {
    AxisMachine machine = parse_axis_machine(json, where, Exit::kData);
    return {machine.system, machine};
  }
  if (!request.arm.is_null() && json.is_object()) json["arm"] = request.arm;
  return {parse_system(json, where)};
}

/// The column that holds what a machine predicts of an axis.
std::string predicted_column(const Axis& axis) { return axis.name + " predicted"; }

/// Adds what the machine predicts, before the low-pass.
void add_predictions(AxisMachine machine, Recording& recording) {
  machine.system.lowpass_hz = 0.0;
  const Eigen::MatrixXd predicted = predict_axes(machine, recording);
  for (std::size_t k = 0; k < machine.system.axes.size(); ++k) {
    recording.set(predicted_column(machine.system.axes[k]), predicted.col(static_cast<Index>(k)));
  }
}

/// The columns of the base simulator that the fitted recordings tell apart.
std::vector<Index> used_columns(const std::vector<Recording>& recordings, const System& system,
                                std::size_t axis, const DerivativeSpec& derivative) {
  Eigen::MatrixXd all(0, 0);
  for (const Recording& recording : recordings) {
    const Eigen::MatrixXd columns = base_columns(recording, system, axis, derivative);
    if (columns.cols() == 0) return {};
    // Every fifth sample tells as much.
    const Index rows = (columns.rows() + 4) / 5, before = all.rows();
    all.conservativeResize(before + rows, columns.cols());
    for (Index k = 0; k < rows; ++k) all.row(before + k) = columns.row(5 * k);
  }
  return independent_columns(all, kBaseTolerance);
}

/// Where an axis' motion ends, and what its position alone makes, 20 Hz or more.
double end_of_motion(const std::vector<Recording>& recordings, const Axis& axis) {
  std::vector<Eigen::VectorXd> positions, forces;
  for (const Recording& recording : recordings) {
    if (!recording.has(axis.position)) continue;
    positions.push_back(recording.column(axis.position));
    forces.push_back(recording.column(axis.measured));
    if (!axis.simulated.empty()) forces.back() -= recording.column(axis.simulated);
  }
  const double dt = recordings.front().dt;
  if (dt == 0.0) return Case().motion_hz;
  const double band = std::max(Case().motion_hz, motion_band(positions, dt));
  return std::max(band, band_of_position_lines(forces, positions, dt, band));
}

/// The columns that laws of the axis may follow.
std::vector<std::string> signals_of(const Axis& axis) {
  std::vector<std::string> names = axis.signals;
  if (std::find(names.begin(), names.end(), "temperature") == names.end()) {
    names.emplace_back("temperature");
  }
  std::erase_if(names, [&](const std::string& name) {
    return name == axis.measured || name == axis.simulated || name == axis.position ||
           name == axis.velocity || name == axis.acceleration;
  });
  return names;
}

Case axis_case(std::shared_ptr<const AxisPlan> plan, double motion_hz) {
  Case study;
  study.own_tool = false;
  study.simulator.model.inertial = ToolModel::Inertial::kNone;
  study.channels = {0};
  study.targets = {plan->axis().measured};
  study.units = {plan->axis().unit};
  study.lowpass_hz = plan->system.lowpass_hz;
  study.motion_hz = motion_hz;
  study.derivative = {.kind = DerivativeSpec::Kind::kSpectral, .cutoff_hz = study.motion_hz};
  study.axis = std::move(plan);
  return study;
}

}  // namespace

void set_axis_motion(Case& study) {
  const AxisPlan& plan = *study.axis;
  for (Log& log : study.logs) {
    log.motion = axis_motion(log.recording, plan.axis(), study.derivative);
    log.regressors.clear();
    const Eigen::MatrixXd columns =
        base_columns(log.recording, plan.system, plan.index, study.derivative);
    log.base = {Eigen::MatrixXd::Zero(log.motion.samples(), 3), Eigen::MatrixXd(0, 3)};
    if (plan.base_is_known) {
      const Eigen::MatrixXd used = columns(Eigen::all, plan.columns);
      log.base.force.col(0) = -plan.sense * used * study.base_coefficients;
      if (plan.base_deviations.size() > 0) log.base_errors = used * plan.base_deviations;
      if (study.base_shift.size() > 0) log.base.force.col(0) += log.base_errors * study.base_shift;
    }
    for (const Index k : plan.columns) {
      if (!plan.base_is_known) log.regressors.emplace_back(-plan.sense * columns.col(k));
    }
    const std::string& simulated = plan.axis().simulated;
    if (!simulated.empty()) log.base.force.col(0) = -plan.sense * log.recording.column(simulated);
    if (!plan.payload) continue;
    // A reaction to the drive, whose torque is the columns'.
    log.base.force.col(0) -=
        payload_columns(log.recording, plan.system, plan.index, study.derivative) * *plan.payload;
  }
  if (!plan.columns.empty() && !plan.base_is_known) set_base(study, study.base_coefficients);
}

void set_base(Case& study, const Eigen::VectorXd& coefficients) {
  if (study.axis->base_is_known) {
    const Eigen::VectorXd before =
        study.base_shift.size() > 0 ? study.base_shift : Eigen::VectorXd::Zero(coefficients.size());
    for (Log& log : study.logs) log.base.force.col(0) += log.base_errors * (coefficients - before);
    study.base_shift = coefficients;
    return;
  }
  study.base_coefficients = coefficients;
  for (Log& log : study.logs) {
    if (log.regressors.empty()) continue;
    log.base.force.setZero();
    for (std::size_t k = 0; k < log.regressors.size(); ++k) {
      log.base.force.col(0) += coefficients(static_cast<Index>(k)) * log.regressors[k];
    }
  }
}

Eigen::VectorXd base_parameters(const Case& study, const Eigen::VectorXd& fitted) {
  if (fitted.size() == 0) return study.base_coefficients;
  const AxisPlan& plan = *study.axis;
  if (!plan.base_is_known) return fitted;
  return study.base_coefficients - plan.sense * (plan.base_deviations * fitted);
}

Signals unfiltered_left(const Case& study, const std::vector<Member>& members) {
  Case raw = study;
  raw.lowpass_hz = 0.0;
  Signals left = predict(raw, members);
  for (std::size_t k = 0; k < left.size(); ++k) {
    const Log& log = study.logs[k];
    left[k] = (study.lowpass_hz > 0.0 ? log.unfiltered : log.measured) - left[k];
  }
  return left;
}

bool is_corrected(const Case& study) {
  return study.axis && (study.axis->payload || study.axis->given.size() > 0);
}

Case as_given(Case study) {
  AxisPlan plan = *study.axis;
  plan.payload.reset();
  if (plan.given.size() > 0) study.base_coefficients = plan.sense * plan.given;
  study.axis = std::make_shared<const AxisPlan>(std::move(plan));
  set_axis_motion(study);
  return study;
}

LoadedAxes load_axes(const DiagnosisRequest& request) {
  auto [system, machine] = given_system(request);
  require(system.kind == System::Kind::kAxes, Exit::kData, request.system->string(),
          ": describes a wrist tool; give --sim instead, or \"kind\": \"axes\"");
  auto fit = read_all(request.fit, request, system);
  auto holdout = read_all(request.holdout, request, system);
  const std::vector<Recording*> both =
      with_usable_rows(fit, holdout, system, find_targets(fit.front(), system).names);
  if (machine) {
    for (Recording* recording : both) add_predictions(*machine, *recording);
    for (Axis& axis : system.axes) {
      axis.simulated = predicted_column(axis);
      axis.base.clear();
      axis.has_base = false;
    }
  }
  std::vector<double> motion_hz;
  for (const Axis& axis : system.axes) motion_hz.push_back(end_of_motion(fit, axis));
  if (!machine) leave_lagging_rates(fit, system, motion_hz);
  std::vector<Recording> all = fit;
  all.insert(all.end(), holdout.begin(), holdout.end());
  check_rates(all);
  std::vector<LoadedCase> cases;
  for (std::size_t k = 0; k < system.axes.size(); ++k) {
    AxisPlan plan;
    plan.system = system;
    plan.index = k;
    const Case draft = axis_case(std::make_shared<const AxisPlan>(plan), motion_hz[k]);
    plan.columns = used_columns(fit, system, k, draft.derivative);
    Axis own = system.axes[k];
    if (machine) own.simulated.clear();  // the drive's own: its sign is what is asked
    plan.sense = sense_of(fit, system, own, draft.derivative);
    LoadedCase loaded;
    loaded.fit = axis_case(std::make_shared<const AxisPlan>(std::move(plan)), motion_hz[k]);
    loaded.fit.without = request.without;
    loaded.fit.base_coefficients =
        Eigen::VectorXd::Zero(static_cast<Index>(loaded.fit.axis->columns.size()));
    set_clock(request, all, loaded.fit);
    loaded.fit.drivers = drivers_of(signals_of(system.axes[k]), fit, holdout);
    loaded.holdout = loaded.fit;
    for (const Recording& r : fit) loaded.fit.logs.push_back(make_log(r, loaded.fit));
    for (const Recording& r : holdout) loaded.holdout.logs.push_back(make_log(r, loaded.fit));
    set_derivative(loaded.fit, loaded.fit.derivative);  // and the fastest speeds
    loaded.fit.axis_moves = moves(loaded.fit);
    set_axis_units(loaded.fit);
    set_axis_motion(loaded.holdout);
    cases.push_back(std::move(loaded));
  }
  Json finding = share_base(cases);
  return {std::move(cases), std::move(finding), std::move(machine)};
}

}  // namespace dcnn
