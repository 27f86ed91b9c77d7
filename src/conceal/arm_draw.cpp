// SPDX-License-Identifier: Apache-2.0
#include "conceal/arm_draw.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/elementary.h"
#include "dcnn/conceal/arm.h"
#include "dcnn/core/error.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr int kPerReading = 16;  // of the 4000 Hz world: 250 Hz

/// Torques at the world's rate, on straight lines between those of every fourth row: motion is slow
/// beside 1 kHz.
MatrixXd torques_of(const std::vector<Limb>& limbs, const MatrixXd& angles) {
  constexpr Index kEvery = 4;
  const Index coarse = (angles.rows() - 1) / kEvery + 1;
  MatrixXd q(coarse, angles.cols()), fine(angles.rows(), angles.cols());
  for (Index i = 0; i < coarse; ++i) q.row(i) = angles.row(kEvery * i);
  const MatrixXd torque = drive_torques(limbs, q, kEvery * kStep, kGravity);
  for (Index i = 0; i < fine.rows(); ++i) {
    const Index k = std::min(i / kEvery, coarse - 2);
    const double part = static_cast<double>(i - kEvery * k) / kEvery;
    fine.row(i) = torque.row(k) + part * (torque.row(k + 1) - torque.row(k));
  }
  return fine;
}

/// Effects that one joint of an arm can have: its log has one clock and nobody pushes at a single
/// joint.
const std::vector<std::string>& joint_effects() {
  static const std::vector<std::string> ids{"coulomb_friction",
                                            "viscous_friction",
                                            "stribeck_friction",
                                            "quadratic_drag",
                                            "lugre_friction",
                                            "hysteresis",
                                            "cable_spring",
                                            "cogging",
                                            "bias",
                                            "gain",
                                            "lowpass",
                                            "linear_drift",
                                            "step_bias",
                                            "hum",
                                            "load_friction",
                                            "gear_friction",
                                            "asymmetric_friction"};
  return ids;
}

/// The path of one joint as of a tool that slides along base_x and turns by alpha.
Path joint_path(const Eigen::VectorXd& q, const Eigen::VectorXd& torque, double start) {
  MatrixXd pose = MatrixXd::Zero(q.size(), 6);
  pose.col(0) = pose.col(3) = q;
  std::vector<Eigen::Matrix3d> still(static_cast<std::size_t>(q.size()),
                                     Eigen::Matrix3d::Identity());
  Path path = follow(start, pose, std::move(still), Vector3d::Zero());
  path.load = path.rigid = MatrixXd::Zero(q.size(), 3);
  path.load.col(0) = torque;
  path.rigid.col(0) = -torque;
  return path;
}

struct ArmRequestId {
  std::string group, effect;
  double amplitude = 1.0;
  std::size_t number = 0;
};

ArmRequestId parse_arm_id(const std::string& id) {
  const auto colon = id.find(':'), first = id.find('/'), second = id.rfind('/');
  require(colon < first && first < second, Exit::kUsage, id, ": write group:value/effect/number");
  ArmRequestId r{id.substr(0, colon), id.substr(first + 1, second - first - 1)};
  const std::string value = id.substr(colon + 1, first - colon - 1), number = id.substr(second + 1);
  std::from_chars(value.data(), value.data() + value.size(), r.amplitude);
  std::from_chars(number.data(), number.data() + number.size(), r.number);
  require(has("null single payload loaded", r.group), Exit::kUsage, id,
          ": no group of arms is called ", r.group);
  require(r.group != "single" ||
              std::count(joint_effects().begin(), joint_effects().end(), r.effect) == 1,
          Exit::kUsage, id, ": no effect of a joint is called ", r.effect);
  return r;
}

/// A body at the flange, hidden as the report names it.
Hidden draw_payload(const ArmScenario& s, std::vector<Limb>& loaded, Rng& rng) {
  const double mass = logarithmic(rng, 0.5, 5.0);
  const Vector3d centre(rng.uniform(-0.06, 0.06), rng.uniform(-0.06, 0.06),
                        rng.uniform(0.02, 0.12));
  const Vector3d radii(rng.uniform(0.02, 0.06), rng.uniform(0.02, 0.06), rng.uniform(0.02, 0.06));
  for (const PointMass& m : solid(mass, s.flange + centre, radii, drawn_turn(rng))) {
    loaded.back().masses.push_back(m);
  }
  Hidden h;
  h.effect = "payload";
  h.parameters = {{"delta_mass_kg", mass},
                  {"delta_com_x_m", centre.x()},
                  {"delta_com_y_m", centre.y()},
                  {"delta_com_z_m", centre.z()}};
  h.amplitude = 1.0;
  return h;
}

Hidden draw_joint_effect(const std::string& effect, Rng& rng) {
  Hidden h;
  h.effect = effect;
  if (effect.find("friction") != std::string::npos || effect == "quadratic_drag") h.axis = "base_x";
  if (has("cable_spring hysteresis cogging gear_friction", effect)) h.axis = "alpha:base_x";
  h.parameters = draw_parameters(effect, h.axis, rng);
  for (auto& [name, value] : h.parameters) {  // a joint has one component, x
    if (name == "gain_y" || name == "gain_z" || name.find("_y_") != std::string::npos ||
        name.find("_z_") != std::string::npos)
      value = 0.0;
  }
  return h;
}

/// In the terms of the joint's drive, which the tool's force is the reaction to: one component, and
/// the sign of the reading where the effect adds to it.
Hidden of_joint(Hidden h, std::size_t joint) {
  h.axis = "joint" + std::to_string(joint + 1);
  const bool adds = has("bias linear_drift step_bias hum", h.effect);
  std::erase_if(h.parameters, [](const auto& p) {
    return p.first == "gain_y" || p.first == "gain_z" || p.first.find("_y_") != std::string::npos ||
           p.first.find("_z_") != std::string::npos;
  });
  for (auto& [name, value] : h.parameters) {
    if (adds && name.find("_x_") != std::string::npos) value = -value;
  }
  return h;
}

std::vector<std::pair<std::size_t, std::string>> wanted_effects(const ArmRequestId& r,
                                                                std::size_t joints, Rng& rng) {
  std::vector<std::pair<std::size_t, std::string>> list;
  if (r.group == "single") list.emplace_back(rng.below(joints), r.effect);
  for (std::size_t j = 0; j < joints && r.group == "loaded"; ++j) {
    list.emplace_back(j, "coulomb_friction");
    list.emplace_back(j, "viscous_friction");
  }
  return list;
}

double rms_of(const std::vector<MatrixXd>& torques, Index joint) {
  double square = 0.0, rows = 0.0;
  for (const MatrixXd& t : torques) {
    square += t.col(joint).squaredNorm();
    rows += static_cast<double>(t.rows());
  }
  return std::sqrt(square / rows);
}

/// White, or the autoregression of tools' logs (0.8 from one sample of 500 Hz to the next).
MatrixXd torque_noise(const ArmScenario& s, std::size_t joint, Index rows, Rng& rng) {
  MatrixXd noise = MatrixXd::Zero(rows, 3);
  const double keep = s.noise == "white" ? 0.0 : 0.64;
  double at = rng.normal();
  for (Index i = 0; i < rows; ++i) {
    at = keep * at + std::sqrt(1.0 - keep * keep) * rng.normal();
    noise(i, 0) = s.sigma[joint] * at;
  }
  return noise;
}

double digits(double value) { return std::round(value * 1e8) / 1e8; }

/// Effects of one joint drawn and scaled, then its readings of all recordings.
void read_joint(ArmScenario& s, std::size_t joint, const std::vector<std::string>& effects,
                double amplitude, const std::vector<MatrixXd>& angles,
                const std::vector<MatrixXd>& torques, Rng& rng) {
  const auto column = static_cast<Index>(joint);
  Scenario one;
  one.tool = {0.0, Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), "none"};
  one.noise.sigma = s.sigma[joint];
  one.conditions.samples_per_reading = kPerReading;
  std::vector<Path> paths;
  for (std::size_t k = 0; k < angles.size() && !effects.empty(); ++k) {
    paths.push_back(joint_path(angles[k].col(column), torques[k].col(column),
                               static_cast<double>(k) * (kArmSeconds + 5.0)));
    one.recordings.emplace_back();
    one.recordings.back().holdout = s.logs[k].holdout;
  }
  for (const std::string& effect : effects) {
    std::optional<Hidden> strong;
    for (int attempt = 0; attempt < 20 && !strong; ++attempt) {
      Hidden h = draw_joint_effect(effect, rng);
      place(h, one, paths, rng);
      strong = of_amplitude(paths, one, h, amplitude * s.sigma[joint]);
    }
    require(strong.has_value(), Exit::kUsage, s.id, ": ", effect,
            " changes nothing; give another seed");
    one.hidden.push_back(*strong);
    s.hidden.push_back(of_joint(*strong, joint));
  }
  for (std::size_t k = 0; k < s.logs.size(); ++k) {
    ArmLog& log = s.logs[k];
    const MatrixXd noise = torque_noise(s, joint, log.t.size(), rng);
    if (effects.empty()) {
      for (Index i = 0; i < log.t.size(); ++i)
        log.clean(i, column) = torques[k](i * kPerReading, column);
      log.measured.col(column) = (log.clean.col(column) + noise.col(0)).unaryExpr(&digits);
      continue;
    }
    log.clean.col(column) = -reading(paths[k], one.tool, one.hidden, {}, kPerReading).col(0);
    log.measured.col(column) =
        -reading(paths[k], one.tool, one.hidden, noise, kPerReading).col(0).unaryExpr(&digits);
  }
}

}  // namespace

std::vector<std::string> arm_plan(int scenarios, std::uint64_t seed) {
  require(scenarios > 0 && scenarios <= 9999, Exit::kUsage,
          "a challenge has 1 to 9999 scenarios, not ", scenarios);
  Rng rng({seed, 21});
  const auto start = static_cast<std::size_t>(rng.below(joint_effects().size()));
  std::vector<std::string> ids;
  std::size_t single = start;
  for (int k = 0; k < scenarios; ++k) {
    const std::string number = "/" + std::to_string(k);
    if (k % 8 == 0) {
      ids.push_back("null:0/none" + number);
    } else if (k % 8 == 2) {
      ids.push_back("payload:1/payload" + number);
    } else if (k % 8 == 5) {
      ids.push_back("loaded:2/any" + number);
    } else {
      ids.push_back("single:1/" + joint_effects()[single++ % joint_effects().size()] + number);
    }
  }
  std::vector<std::string> drawn;  // their order tells nothing
  for (const auto k : permutation(scenarios, rng))
    drawn.push_back(ids[static_cast<std::size_t>(k)]);
  return drawn;
}

ArmScenario draw_arm(const std::string& id, std::uint64_t seed) {
  const ArmRequestId request = parse_arm_id(id);
  std::uint64_t name = 1469598103934665603ULL;  // FNV-1a
  for (const char c : id) name = (name ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  Rng rng({seed, 22, name});
  ArmScenario s;
  s.id = id;
  s.group = request.group;
  const std::size_t joints = rng.uniform() < 0.5 ? 6 : 7;
  s.described = rng.uniform() < 0.5;
  s.limbs = draw_limbs(joints, rng);
  s.flange = {0.0, 0.0, rng.uniform(0.03, 0.12)};
  s.noise = rng.uniform() < 0.7 ? "white" : "ar1";
  s.encoder = logarithmic(rng, 2e-7, 2e-6);
  std::vector<Limb> loaded = s.limbs;
  if (has("payload loaded", s.group)) s.hidden.push_back(draw_payload(s, loaded, rng));
  std::vector<MatrixXd> angles, torques;
  for (int k = 0; k < 3; ++k) {
    angles.push_back(draw_angles(joints, rng));
    const MatrixXd nominal = torques_of(s.limbs, angles.back());
    torques.push_back(s.hidden.empty() ? nominal : torques_of(loaded, angles.back()));
    ArmLog log;
    log.holdout = k == 2;
    log.name = log.holdout ? "holdout_0" : "fit_" + std::to_string(k);
    const Index rows = (angles.back().rows() + kPerReading - 1) / kPerReading;
    log.t.resize(rows);
    log.q.resize(rows, nominal.cols());
    log.simulated = log.measured = log.clean = log.q;
    for (Index i = 0; i < rows; ++i) {
      log.t(i) = digits(k * (kArmSeconds + 5.0) + kPerReading * kStep * static_cast<double>(i));
      for (Index j = 0; j < nominal.cols(); ++j) {
        log.q(i, j) = digits(angles.back()(i * kPerReading, j) + s.encoder * rng.normal());
        log.simulated(i, j) = digits(nominal(i * kPerReading, j));
      }
    }
    s.logs.push_back(std::move(log));
  }
  const auto wanted = wanted_effects(request, joints, rng);
  double strongest = 0.0;
  for (Index j = 0; j < torques[0].cols(); ++j) strongest = std::max(strongest, rms_of(torques, j));
  const double share = logarithmic(rng, 0.005, 0.02);
  for (std::size_t j = 0; j < joints; ++j) {
    s.sigma.push_back(share * std::max(rms_of(torques, static_cast<Index>(j)), 0.05 * strongest));
    std::vector<std::string> own;
    for (const auto& [joint, effect] : wanted) {
      if (joint == j) own.push_back(effect);
    }
    read_joint(s, j, own, request.amplitude, angles, torques, rng);
  }
  return s;
}

}  // namespace dcnn::conceal
