// SPDX-License-Identifier: Apache-2.0
#include "dcnn/identification/arm.h"

#include <algorithm>
#include <cmath>

#include "dcnn/identification/urdf.h"
#include "identification/arm_terms.h"

namespace dcnn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using identification::ArmFit;
using identification::ArmLog;
using identification::Drive;
using identification::DriveTerm;

constexpr double kArm95 = 1.959963985;  // half a 95 % interval in standard deviations
constexpr double kHalved = 0.5;         // of what was known before: a parameter is shown below
constexpr double kShownReach = 0.05;    // m: a payload's centre is shown where it is known better

IdentifiedNumber normal_estimate(const std::string& name, const std::string& unit, double value,
                                 double deviation) {
  return {name, unit, value, value - kArm95 * deviation, value + kArm95 * deviation};
}

/// Stem and unit of a drive's term, `unit` that of the torque.
std::pair<std::string, std::string> term_name(DriveTerm term, const std::string& unit) {
  switch (term) {
    case DriveTerm::kOffset:
      return {"offset", unit};
    case DriveTerm::kDry:
      return {"fc", unit};
    case DriveTerm::kViscous:
      return {"c", unit + "*s/rad"};
    case DriveTerm::kRotor:
      return {"rotor_inertia", unit + "*s^2/rad"};
    case DriveTerm::kLoad:
      return {"mu", ""};
    case DriveTerm::kQuadratic:
      return {"c2", unit + "*s^2/rad^2"};
    case DriveTerm::kStribeck:
      return {"fs_over_fc", unit};
    case DriveTerm::kGain:
      return {"drive_gain", ""};
  }
  return {};
}

JointEstimate joint_estimate(const ArmFit& fit, const System& system, std::size_t j) {
  const Drive& drive = fit.drives[j];
  JointEstimate joint;
  joint.name = system.axes[j].name;
  joint.unit = system.axes[j].unit;
  joint.presliding = drive.presliding;
  joint.creep_s = drive.creep_s;
  joint.residual_rms = fit.residual_rms[static_cast<Index>(j)];
  for (std::size_t t = 0; t < drive.terms.size(); ++t) {
    const Index place = fit.first[j] + static_cast<Index>(t);
    const auto [name, unit] = term_name(drive.terms[t], joint.unit);
    const double shift = drive.terms[t] == DriveTerm::kGain ? drive.gain : 0.0;
    joint.parameters.push_back(
        normal_estimate(name, unit, fit.x[place] + shift, fit.deviation[place]));
  }
  return joint;
}

std::vector<LinkEstimate> link_estimates(const ArmFit& fit, const JointChain& chain) {
  std::vector<LinkEstimate> links;
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    const auto at = 10 * static_cast<Index>(j);
    LinkEstimate link;
    link.name = chain.joints[j].name;
    link.body = fit.x.segment(at, 10);
    link.deviation = fit.deviation.segment(at, 10);
    for (Index k = 0; k < 10; ++k) {
      link.shown.push_back(fit.deviation[at + k] < kHalved * fit.prior_deviation[at + k]);
    }
    links.push_back(link);
  }
  return links;
}

/// Mass and centre of the payload, the centre's deviation to first order in h/m.
std::vector<IdentifiedNumber> payload_estimates(const ArmFit& fit) {
  if (fit.payload < 0) return {};
  const VectorXd p = fit.x.segment(fit.payload, 4);
  const MatrixXd C = fit.covariance.block(fit.payload, fit.payload, 4, 4);
  std::vector<IdentifiedNumber> all{normal_estimate("mass_kg", "kg", p[0], std::sqrt(C(0, 0)))};
  all.front().shown = std::abs(p[0]) > kArm95 * std::sqrt(C(0, 0));
  for (Index i = 1; i < 4; ++i) {
    const double com = p[i] / p[0];
    const double variance = (C(i, i) - 2.0 * com * C(i, 0) + com * com * C(0, 0)) / (p[0] * p[0]);
    const std::string name = std::string("com_") + "xyz"[i - 1] + "_m";
    const double deviation = std::sqrt(std::max(variance, 0.0));
    all.push_back(normal_estimate(name, "m", com, deviation));
    all.back().shown = kArm95 * deviation < kShownReach;
  }
  return all;
}

void set_held_out(const std::vector<ArmLog>& held, const JointChain& chain, const ArmFit& fit,
                  std::vector<JointEstimate>& joints) {
  if (held.empty()) return;
  VectorXd square = VectorXd::Zero(static_cast<Index>(joints.size()));
  double rows = 0.0;
  for (const ArmLog& log : held) {
    const MatrixXd error = log.torque - identification::predicted_torque(chain, fit, log);
    square += error.colwise().squaredNorm().transpose();
    rows += static_cast<double>(error.rows());
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    joints[j].holdout_rms = std::sqrt(square[static_cast<Index>(j)] / rows);
  }
}

void set_torques(const std::vector<ArmLog>& logs, std::vector<JointEstimate>& joints) {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    double square = 0.0, rows = 0.0;
    for (const ArmLog& log : logs) {
      square += log.torque.col(static_cast<Index>(j)).squaredNorm();
      rows += static_cast<double>(log.torque.rows());
    }
    joints[j].torque_rms = std::sqrt(square / rows);
  }
}

}  // namespace

JointChain chain_of(const ArmRequest& request) {
  const System system = read_system(request.system);
  require(system.kind == System::Kind::kAxes, Exit::kData, request.system.string(),
          ": describes a wrist; an arm needs \"kind\": \"axes\"");
  JointChain chain;
  if (!request.urdf.empty()) {
    std::vector<std::string> names;
    for (const Axis& axis : system.axes) names.push_back(axis.name);
    chain = read_urdf_chain(request.urdf, request.tip, names);
    set_gravity(system.arm, request.system.string() + ": arm", Exit::kData, chain);
  } else {
    require(system.arm.is_object(), Exit::kData, request.system.string(),
            ": has no key 'arm' with the DH table; add it, or give --urdf robot.urdf");
    chain = parse_chain(system.arm, request.system.string() + ": arm", Exit::kData);
  }
  require(!request.drive_gains || !request.urdf.empty(), Exit::kUsage,
          "--drive-gains needs --urdf: torques alone do not tell a gain from heavier links");
  require(chain.joints.size() == system.axes.size(), Exit::kData, request.system.string(), ": ",
          system.axes.size(), " axes for an arm of ", chain.joints.size(),
          " joints; give one axis per joint, in order");
  for (std::size_t k = 0; k < chain.joints.size(); ++k) {
    chain.joints[k].name = system.axes[k].name;
  }
  return chain;
}

ArmIdentification identify_arm(const ArmRequest& request) {
  const System system = read_system(request.system);
  const JointChain chain = chain_of(request);
  auto logs = identification::read_arm_logs(request.logs, false, system, chain);
  for (auto& log : identification::read_arm_logs(request.loaded, true, system, chain)) {
    logs.push_back(std::move(log));
  }
  const auto held = identification::read_arm_logs(request.holdout, false, system, chain);
  const ArmFit fit = identification::fit_arm(chain, logs, request.drive_gains);

  ArmIdentification result;
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    result.joints.push_back(joint_estimate(fit, system, j));
  }
  set_torques(logs, result.joints);
  set_held_out(held, chain, fit, result.joints);
  result.links = link_estimates(fit, chain);
  JointChain found = chain;
  for (std::size_t j = 0; j < found.joints.size(); ++j) found.joints[j].body = result.links[j].body;
  result.system = system.json;
  result.system["arm"] = to_json(found);
  result.base_parameters = identification::told_combinations(logs);
  result.payload = payload_estimates(fit);
  for (const ArmLog& log : logs) {
    result.lowpass_hz = std::max(result.lowpass_hz, log.clock.cutoff_hz);
    const Recording& recording = log.clock.recording;
    result.recordings.push_back(recording.name);
    for (const auto& note : recording.notes) result.notes.push_back(recording.name + ": " + note);
  }
  for (const ArmLog& log : held) result.holdout.push_back(log.clock.recording.name);
  return result;
}

}  // namespace dcnn
