// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/axis_machine.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "dcnn/data/filter.h"
#include "physics/driven.h"

namespace dcnn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Rates {
  VectorXd q, v, a;  // empty where nothing logged tells it
};

Rates rates_of(const Recording& recording, const Axis& axis, const DerivativeSpec& spec) {
  Rates rates;
  if (!axis.position.empty()) rates.q = recording.column(axis.position);
  if (!axis.velocity.empty()) rates.v = recording.column(axis.velocity);
  if (!axis.acceleration.empty()) rates.a = recording.column(axis.acceleration);
  if (recording.dt == 0.0) {  // positions at rest
    rates.v = rates.a = VectorXd::Zero(recording.samples());
    return rates;
  }
  const bool has_v = rates.v.size() > 0, has_a = rates.a.size() > 0;
  if (!has_v && rates.q.size() > 0) {
    const Derivatives d = differentiate(rates.q, recording, spec);
    rates.v = d.first.col(0);
    if (!has_a) rates.a = d.second.col(0);
  } else if (!has_a && has_v) {
    rates.a = differentiate(rates.v, recording, spec).first.col(0);
  }
  return rates;
}

bool is_temperature(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name.starts_with("temp");
}

VectorXd named_signal(const Recording& recording, const Axis& axis, const Rates& rates,
                      const std::string& name) {
  const VectorXd& own = name == "position"       ? rates.q
                        : name == "velocity"     ? rates.v
                        : name == "acceleration" ? rates.a
                                                 : VectorXd();
  if (own.size() > 0) return own;
  const bool rate = name == "position" || name == "velocity" || name == "acceleration";
  require(!rate, Exit::kData, "axis '", axis.name, "': base '", name,
          "' needs a column; name the axis' position or ", name, " in the system description");
  require(recording.has(name), Exit::kData, recording.name, ":1: column '", name,
          "' of the base of axis '", axis.name,
          "' is missing; add it or correct the system description");
  return recording.column(name);
}

/// What each inertial parameter of the links adds to a joint's drive, (T, 10·joints).
MatrixXd arm_columns(const JointChain& chain, const Recording& recording, const System& system,
                     std::size_t joint, const DerivativeSpec& spec) {
  const auto n = static_cast<Index>(system.axes.size());
  MatrixXd q(recording.samples(), n), v = q, a = q;
  for (Index k = 0; k < n; ++k) {
    const Axis& axis = system.axes[static_cast<std::size_t>(k)];
    const Rates rates = rates_of(recording, axis, spec);
    require(rates.q.size() > 0 && rates.a.size() > 0, Exit::kData, "axis '", axis.name,
            "': an arm needs the position of every axis; name its column");
    q.col(k) = rates.q;
    v.col(k) = rates.v;
    a.col(k) = rates.a;
  }
  return chain_regressor(chain, q, v, a, joint);
}

/// The tool that an axis does not have.
Simulator without_tool() {
  Simulator simulator;
  simulator.model.inertial = ToolModel::Inertial::kNone;
  return simulator;
}

}  // namespace

JointChain chain_of(const System& system) {
  const JointChain chain = parse_chain(system.arm, "system: arm", Exit::kData);
  require(chain.joints.size() == system.axes.size(), Exit::kData, "system: arm: has ",
          chain.joints.size(), " joints for ", system.axes.size(),
          " axes; give one row of 'dh', or one entry of 'joints', for each axis");
  return chain;
}

MatrixXd payload_columns(const Recording& recording, const System& system, std::size_t axis,
                         const DerivativeSpec& derivative) {
  const JointChain chain = chain_of(system);
  return arm_columns(chain, recording, system, axis, derivative).rightCols(10) *
         flange_to_link(chain);
}

Motion axis_motion(const Recording& recording, const Axis& axis, const DerivativeSpec& derivative) {
  const Rates rates = rates_of(recording, axis, derivative);
  const Index samples = recording.samples();
  Motion motion;
  motion.recording = recording.name;
  motion.has_clock = recording.has("t");
  motion.t = times_of(recording);
  motion.dt = recording.dt;
  motion.of_axis = true;
  motion.segments = recording.segments;
  motion.R_BS.assign(static_cast<std::size_t>(samples), Eigen::Matrix3d::Identity());
  motion.euler = motion.w_S = motion.dw_S = MatrixXd::Zero(samples, 3);
  motion.v_B = motion.a_B = MatrixXd::Zero(rates.v.size(), 3);
  if (rates.q.size() > 0) motion.euler.col(0) = rates.q;
  if (rates.v.size() > 0) {
    motion.v_B.col(0) = rates.v;
    motion.a_B.col(0) = rates.a;
  }
  read_signals(recording, axis.signals, motion);
  for (const std::string& signal : axis.signals) {
    if (is_temperature(signal)) motion.temperature = recording.column(signal);
  }
  if (recording.has("temperature")) {
    motion.temperature = recording.column("temperature");
    motion.signals.push_back({"temperature", motion.temperature});
  }
  return motion;
}

bool is_derived(const System& system, std::size_t axis) {
  const auto derived = [](const Axis& a) { return a.velocity.empty() || a.acceleration.empty(); };
  if (system.arm.is_null()) return derived(system.axes[axis]);
  return std::any_of(system.axes.begin(), system.axes.end(), derived);
}

MatrixXd base_columns(const Recording& recording, const System& system, std::size_t axis,
                      const DerivativeSpec& derivative) {
  const Axis& own = system.axes[axis];
  if (!own.simulated.empty()) return MatrixXd(recording.samples(), 0);
  if (!own.has_base && !system.arm.is_null()) {
    return arm_columns(chain_of(system), recording, system, axis, derivative);
  }
  require(
      own.has_base, Exit::kData, "axis '", own.name,
      "': no simulator; give 'simulated', 'base' (a list of signals, [] where nothing is known), "
      "or 'arm' in the system description");
  if (own.base.empty()) return VectorXd::Ones(recording.samples());
  const Rates rates = rates_of(recording, own, derivative);
  MatrixXd columns(recording.samples(), static_cast<Index>(own.base.size()));
  for (std::size_t k = 0; k < own.base.size(); ++k) {
    columns.col(static_cast<Index>(k)) = named_signal(recording, own, rates, own.base[k]);
  }
  return columns;
}

std::vector<std::string> base_names(const System& system, std::size_t axis) {
  const Axis& own = system.axes[axis];
  if (!own.simulated.empty()) return {};
  if (own.has_base) return own.base.empty() ? std::vector<std::string>{"constant"} : own.base;
  std::vector<std::string> names;
  for (std::size_t link = 0; link < system.axes.size(); ++link) {
    for (const auto& parameter : kLinkParameters) {
      names.push_back(parameter + std::to_string(link + 1));
    }
  }
  return names;
}

MatrixXd predict_axes(const AxisMachine& machine, const Recording& recording) {
  const System& system = machine.system;
  MatrixXd predicted(recording.samples(), static_cast<Index>(machine.axes.size()));
  const Simulator none = without_tool();
  for (std::size_t k = 0; k < machine.axes.size(); ++k) {
    const CorrectedAxis& corrected = machine.axes[k];
    const Axis& axis = system.axes[k];
    const Motion motion = axis_motion(recording, axis, corrected.derivative);
    Wrench reaction{MatrixXd::Zero(motion.samples(), 3), MatrixXd(0, 3)};
    if (!axis.simulated.empty()) {
      reaction.force.col(0) = -corrected.sense * recording.column(axis.simulated);
    } else {
      const MatrixXd columns = base_columns(recording, system, k, corrected.derivative);
      reaction.force.col(0) =
          -corrected.sense * (columns(Eigen::all, corrected.columns) * corrected.coefficients);
    }
    if (machine.payload) {
      reaction.force.col(0) -=
          payload_columns(recording, system, k, corrected.derivative) * *machine.payload;
    }
    pass_on(corrected.effects, Stage::kForce, motion, none.model, reaction);
    predicted.col(static_cast<Index>(k)) = -corrected.sense * reaction.force.col(0);
  }
  return low_pass(predicted, recording, system.lowpass_hz);
}

Recording predict_motion(const AxisMachine& machine, const Recording& motion) {
  Recording predicted = motion;
  const MatrixXd torques = predict_axes(machine, motion);
  for (std::size_t k = 0; k < machine.system.axes.size(); ++k) {
    const Axis& axis = machine.system.axes[k];
    predicted.set(axis.measured, torques.col(static_cast<Index>(k)) / axis.scale);
  }
  return predicted;
}

}  // namespace dcnn
