// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "conceal/arm_draw.h"
#include "conceal/faulty_alter.h"
#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using List = std::vector<std::string>;

constexpr Index kArmStride = 16;    // 250 Hz
constexpr std::size_t kLoaded = 3;  // joints 2 to 4 carry weight that their angles move

/// Those of a common robot with six joints, whose alphabet is not their order.
List names_of(std::size_t joints) {
  if (joints == 6) return {"pan", "lift", "elbow", "wrist_1", "wrist_2", "wrist_3"};
  List names;
  for (std::size_t j = 1; j <= joints; ++j) names.push_back("joint" + std::to_string(j));
  return names;
}

/// As somebody described it: masses, centres and sizes are a few percent off.
std::vector<Limb> described(std::vector<Limb> limbs, Rng& rng) {
  for (Limb& limb : limbs) {
    const double mass = rng.uniform(0.9, 1.1), size = rng.uniform(0.95, 1.05);
    for (PointMass& point : limb.masses) point.mass *= mass, point.at *= size;
  }
  return limbs;
}

Json description(const std::vector<Limb>& limbs, double flange, const List& names) {
  Json axes = Json::array();
  for (std::size_t j = 0; j < limbs.size(); ++j) {
    const std::string number = std::to_string(j + 1);
    axes.push_back({{"name", names[j]},
                    {"measured", "tau_" + number},
                    {"unit", "N*m"},
                    {"position", "q_" + number},
                    {"velocity", "qd_" + number}});
  }
  return {
      {"kind", "axes"}, {"axes", axes}, {"arm", arm_json(limbs, {0.0, 0.0, flange}, names, true)}};
}

struct DrawnArm {
  Eigen::MatrixXd q, qd, torque;  // (T, joints) at 250 Hz
};

/// Rigid torques at 1 kHz, of which every fourth is kept.
DrawnArm move(const std::vector<Limb>& limbs, const Eigen::Vector3d& gravity, Rng& rng) {
  constexpr Index kCoarse = 4;  // 4000 Hz to 1 kHz
  const Eigen::MatrixXd all = draw_angles(limbs.size(), rng);
  const auto rows = static_cast<Index>(rng.uniform(12.0, 18.0) / kStep) / kArmStride;
  Eigen::MatrixXd q(rows * kArmStride / kCoarse, all.cols());
  for (Index i = 0; i < q.rows(); ++i) q.row(i) = all.row(kCoarse * i);
  const Eigen::MatrixXd torque = drive_torques(limbs, q, kCoarse * kStep, gravity);
  DrawnArm out{Eigen::MatrixXd(rows, q.cols()), Eigen::MatrixXd(rows, q.cols()),
               Eigen::MatrixXd(rows, q.cols())};
  for (Index i = 0; i < rows; ++i) {
    const Index k = i * kArmStride / kCoarse;
    out.q.row(i) = q.row(k);
    out.torque.row(i) = torque.row(k);
    const Index a = std::max<Index>(0, k - 1), b = std::min(q.rows() - 1, k + 1);
    out.qd.row(i) = (q.row(b) - q.row(a)) / (static_cast<double>(b - a) * kCoarse * kStep);
  }
  return out;
}

/// Dry and viscous friction, a drive whose constant is a few percent off, noise, an offset.
Eigen::VectorXd logged(const DrawnArm& arm, Index joint, Rng& rng) {
  const Eigen::VectorXd rigid = arm.torque.col(joint), v = arm.qd.col(joint);
  const double size = std::sqrt(arm.torque.squaredNorm() / static_cast<double>(arm.torque.size()));
  const double own = std::sqrt(rigid.squaredNorm() / static_cast<double>(rigid.size()));
  const double scale = std::max(own, 0.05 * size);
  const double gain = rng.uniform(0.95, 1.05), dry = scale * rng.uniform(0.02, 0.2),
               viscous = scale * rng.uniform(0.02, 0.2), offset = scale * rng.uniform(-0.05, 0.05),
               noise = scale * rng.uniform(0.005, 0.02);
  Eigen::VectorXd out(rigid.size());
  for (Index i = 0; i < out.size(); ++i) {
    out[i] = rounded(gain * (rigid[i] + dry * elementary::tanh(v[i] / 0.02) + viscous * v[i]) +
                         offset + noise * rng.normal(),
                     1e5);
  }
  return out;
}

std::size_t joints_of(const Table& t) {
  std::size_t joints = 0;
  while (std::find(t.columns.begin(), t.columns.end(), "q_" + std::to_string(joints + 1)) !=
         t.columns.end()) {
    ++joints;
  }
  require(joints >= kLoaded + 1, Exit::kUsage, "this fault needs a log with q_1 to q_4");
  return joints;
}

std::string loaded_joint(Rng& rng) { return std::to_string(2 + rng.below(kLoaded)); }

void scale_each(Table& t, const List& stems, double factor) {
  for (std::size_t j = 1; j <= joints_of(t); ++j) {
    for (const std::string& stem : stems) column(t, stem + std::to_string(j)) *= factor;
  }
}

void turn_joint(Table& t, Rng& rng, const List& stems) {
  const std::string joint = loaded_joint(rng);
  for (const std::string& stem : stems) column(t, stem + joint) *= -1.0;
}

/// Columns of joint order[k] stand where those of joint k were.
void reorder(Table& t, const std::vector<std::size_t>& order) {
  const Table before = t;
  for (std::size_t k = 0; k < order.size(); ++k) {
    for (const char* stem : {"q_", "qd_", "tau_"}) {
      column(t, stem + std::to_string(k + 1)) =
          before.values.col(column_of(before, stem + std::to_string(order[k] + 1)));
    }
  }
}

void order_by_alphabet(Table& t) {
  const List names = names_of(joints_of(t));
  std::vector<std::size_t> order(names.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return names[a] < names[b]; });
  reorder(t, order);
}

void exchange_two(Table& t, Rng& rng) {
  std::vector<std::size_t> order(joints_of(t));
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const std::size_t a = 1 + rng.below(2);
  std::swap(order[a], order[a + 1]);
  reorder(t, order);
}

void log_currents(Table& t, Rng& rng) {
  for (std::size_t j = 1; j <= joints_of(t); ++j) {
    column(t, "tau_" + std::to_string(j)) /= logarithmic(rng, 5.0, 100.0);
  }
}

void shift_zero(Table& t, Rng& rng) {
  const double turn = one_of<double>(rng, {0.5, -0.5, 1.0}) * std::numbers::pi;
  column(t, "q_" + loaded_joint(rng)).array() += turn;
}

}  // namespace

FaultyLog make_arm(CleanLog kind, Rng& rng) {
  const bool six = kind == CleanLog::kSixJoints || rng.uniform() < 0.5;
  const std::vector<Limb> limbs = draw_limbs(six ? 6 : 7, rng);
  const double flange = rng.uniform(0.03, 0.12);
  std::vector<Limb> loaded = limbs;
  if (rng.uniform() < 0.5) {
    const Eigen::Vector3d centre(0.0, 0.0, flange + rng.uniform(0.02, 0.1));
    for (const PointMass& point : solid(logarithmic(rng, 0.3, 3.0), centre, {0.03, 0.03, 0.03},
                                        Eigen::Matrix3d::Identity())) {
      loaded.back().masses.push_back(point);
    }
  }
  Eigen::Vector3d gravity = kGravity;
  if (kind == CleanLog::kHanging) gravity *= -1.0;
  if (kind == CleanLog::kOnWall) gravity = {0.0, 9.81, 0.0};
  if (kind == CleanLog::kWeightless) gravity.setZero();
  const DrawnArm arm = move(loaded, gravity, rng);
  const Index rows = arm.q.rows();
  FaultyLog out;
  out.table = {{"t"}, Eigen::VectorXd(rows)};
  for (Index i = 0; i < rows; ++i)
    out.table.values(i, 0) = rounded(static_cast<double>(i) * kArmStride * kStep, 1e6);
  for (Index j = 0; j < arm.q.cols(); ++j) {
    const std::string number = std::to_string(j + 1);
    append(out.table, "q_" + number,
           arm.q.col(j).unaryExpr([&](double x) { return rounded(x + 2e-6 * rng.normal(), 1e7); }));
    append(out.table, "qd_" + number, arm.qd.col(j).unaryExpr([&](double x) {
      return rounded(x + 1e-3 * rng.normal(), 1e7);
    }));
    append(out.table, "tau_" + number, logged(arm, j, rng));
  }
  out.system = description(described(limbs, rng), flange, names_of(limbs.size()));
  return out;
}

const std::vector<FaultyKind>& faults_of_arms() {
  using C = CleanLog;
  static const std::vector<FaultyKind> kinds{
      {"arm_sign", "joint_sign", C::kArm,
       [](Table& t, Rng& rng) {
         turn_joint(t, rng, {"q_", "qd_"});
       }},
      {"arm_mirrored", "joint_sign", C::kArm,
       [](Table& t, Rng& rng) {
         turn_joint(t, rng, {"q_", "qd_", "tau_"});
       }},
      {"arm_torque_sign", "power_sign", C::kArm,
       [](Table& t, Rng& rng) { turn_joint(t, rng, {"tau_"}); }},
      {"arm_reaction", "power_sign", C::kArm,
       [](Table& t, Rng&) { scale_each(t, {"tau_"}, -1.0); }},
      {"arm_zero", "joint_zero", C::kArm, shift_zero},
      {"arm_exchanged", "joint_order", C::kArm, exchange_two},
      {"arm_alphabet", "joint_order", C::kSixJoints, [](Table& t, Rng&) { order_by_alphabet(t); }},
      {"arm_deg", "angle_unit", C::kArm,
       [](Table& t, Rng&) {
         scale_each(t, {"q_", "qd_"}, 180.0 / std::numbers::pi);
       }},
      {"arm_mnm", "torque_unit", C::kArm, [](Table& t, Rng&) { scale_each(t, {"tau_"}, 1e3); }},
      {"arm_kgfcm", "torque_unit", C::kArm,
       [](Table& t, Rng&) { scale_each(t, {"tau_"}, 1.0 / 9.80665e-2); }},
      {"arm_current", "torque_unit", C::kArm, log_currents},
      {"arm_ceiling", "gravity_direction", C::kHanging, [](Table&, Rng&) {}},
      {"arm_wall", "gravity_direction", C::kOnWall, [](Table&, Rng&) {}},
      {"arm_compensated", "compensated", C::kWeightless, [](Table&, Rng&) {}},
      {"clean_arm", "", C::kArm, [](Table&, Rng&) {}},
  };
  return kinds;
}

}  // namespace dcnn::conceal
