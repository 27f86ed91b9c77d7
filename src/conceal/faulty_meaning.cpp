// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "conceal/faulty_alter.h"
#include "dcnn/data/rotation.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
constexpr double kToDegrees = 180.0 / std::numbers::pi;
using List = std::vector<std::string>;

void scale(Table& t, const List& names, double factor) {
  for (const std::string& name : names) column(t, name) *= factor;
}

void exchange(Table& t, const std::string& a, const std::string& b) {
  const Eigen::VectorXd kept = column(t, a);
  column(t, a) = column(t, b);
  column(t, b) = kept;
}

Eigen::Vector3d three_at(Table& t, Index i, const List& names) {
  return {column(t, names[0])[i], column(t, names[1])[i], column(t, names[2])[i]};
}

void put_three(Table& t, Index i, const List& names, const Eigen::Vector3d& v) {
  for (std::size_t k = 0; k < 3; ++k) column(t, names[k])[i] = v[static_cast<Index>(k)];
}

const List kF{"fx", "fy", "fz"}, kAngles{"alpha", "beta", "gamma"}, kW{"wx", "wy", "wz"},
    kV{"vx", "vy", "vz"}, kT{"tx", "ty", "tz"};

/// Each row's vector by its pose's rotation.
void turn_to_base(Table& t, const List& names) {
  for (Index i = 0; i < t.values.rows(); ++i) {
    const Eigen::Matrix3d R = rotation_from_euler(three_at(t, i, kAngles));
    put_three(t, i, names, R * three_at(t, i, names));
  }
}

/// Angles whose product of elementary turns, z last, is the same rotation: Rx(a) Ry(b) Rz(c).
void log_as_xyz(Table& t) {
  for (Index i = 0; i < t.values.rows(); ++i) {
    // Rx(a) Ry(b) Rz(c) transposed is Rz(-c) Ry(-b) Rx(-a).
    const Eigen::Vector3d e =
        -euler_from_rotation(rotation_from_euler(three_at(t, i, kAngles)).transpose());
    put_three(t, i, kAngles, {e[2], e[1], e[0]});
  }
}

void invert(Table& t) {
  for (Index i = 0; i < t.values.rows(); ++i) {
    put_three(t, i, kAngles,
              euler_from_rotation(rotation_from_euler(three_at(t, i, kAngles)).transpose()));
  }
}

/// The scalar is written last, under the names of before.
void scalar_last(Table& t) {
  const Eigen::VectorXd w = column(t, "qw");
  const List names{"qw", "qx", "qy", "qz"};
  for (std::size_t k = 0; k < 3; ++k)
    column(t, names[k]) = Eigen::VectorXd(column(t, names[k + 1]));
  column(t, "qz") = w;
}

/// What the controller takes for the weight is added: `share` of nearly the tool's mass, which is
/// the fit of the clean force on gravity's direction.
void subtract_weight(Table& t, double share) {
  Eigen::MatrixXd g(t.values.rows(), 3), F(t.values.rows(), 3);
  for (Index i = 0; i < g.rows(); ++i) {
    g.row(i) = rotation_from_euler(three_at(t, i, kAngles)).row(2) * -9.81;
    F.row(i) = three_at(t, i, kF).transpose();
  }
  const Eigen::MatrixXd about = g.rowwise() - g.colwise().mean();
  const double mass =
      (about.array() * (F.rowwise() - F.colwise().mean()).array()).sum() / about.squaredNorm();
  for (Index i = 0; i < g.rows(); ++i) {
    put_three(t, i, kF, (F.row(i) - share * mass * g.row(i)).transpose());
  }
}

void remount(Table& t, Rng& rng, double low, double high) {
  const Eigen::Vector3d axis =
      Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
  const Eigen::Matrix3d Q = Eigen::AngleAxisd(rng.uniform(low, high), axis).toRotationMatrix();
  for (Index i = 0; i < t.values.rows(); ++i) put_three(t, i, kF, Q * three_at(t, i, kF));
}

}  // namespace

const std::vector<FaultyKind>& faults_of_meaning() {
  using C = CleanLog;
  static const std::vector<FaultyKind> kinds{
      {"angle_deg", "angle_unit", C::kEuler, [](Table& t, Rng&) { scale(t, kAngles, kToDegrees); }},
      {"position_mm", "position_unit", C::kEuler,
       [](Table& t, Rng&) {
         scale(t, {"x", "y", "z"}, 1e3);
       }},
      {"position_cm", "position_unit", C::kEuler,
       [](Table& t, Rng&) {
         scale(t, {"x", "y", "z"}, 1e2);
       }},
      {"force_mn", "force_unit", C::kEuler, [](Table& t, Rng&) { scale(t, kF, 1e3); }},
      {"force_kgf", "force_unit", C::kEuler, [](Table& t, Rng&) { scale(t, kF, 1.0 / 9.80665); }},
      {"force_gf", "force_unit", C::kEuler, [](Table& t, Rng&) { scale(t, kF, 1e3 / 9.80665); }},
      {"reaction", "reaction", C::kEuler, [](Table& t, Rng&) { scale(t, kF, -1.0); }},
      {"sign_fx", "force_sign", C::kEuler, [](Table& t, Rng&) { scale(t, {"fx"}, -1.0); }},
      {"sign_fy", "force_sign", C::kEuler, [](Table& t, Rng&) { scale(t, {"fy"}, -1.0); }},
      {"sign_fz", "force_sign", C::kQuaternion, [](Table& t, Rng&) { scale(t, {"fz"}, -1.0); }},
      {"swap_xy", "force_axes", C::kEuler, [](Table& t, Rng&) { exchange(t, "fx", "fy"); }},
      {"swap_yz", "force_axes", C::kEuler, [](Table& t, Rng&) { exchange(t, "fy", "fz"); }},
      {"turned_90", "force_axes", C::kQuaternion,
       [](Table& t, Rng&) { exchange(t, "fx", "fy"), scale(t, {"fx"}, -1.0); }},
      {"turned_180", "force_axes", C::kEuler,
       [](Table& t, Rng&) {
         scale(t, {"fx", "fy"}, -1.0);
       }},
      {"base_frame", "base_frame", C::kEuler, [](Table& t, Rng&) { turn_to_base(t, kF); }},
      {"quaternion_xyzw", "quaternion_order", C::kQuaternion,
       [](Table& t, Rng&) { scalar_last(t); }},
      {"euler_exchanged", "euler_order", C::kEuler,
       [](Table& t, Rng&) { exchange(t, "alpha", "gamma"); }},
      {"euler_xyz", "euler_order", C::kEuler, [](Table& t, Rng&) { log_as_xyz(t); }},
      {"inverse_pose", "inverse_pose", C::kEuler, [](Table& t, Rng&) { invert(t); }},
      {"sign_beta", "angle_sign", C::kEuler, [](Table& t, Rng&) { scale(t, {"beta"}, -1.0); }},
      {"sign_gamma", "angle_sign", C::kEuler, [](Table& t, Rng&) { scale(t, {"gamma"}, -1.0); }},
      {"swap_x_y", "position_axes", C::kBrisk, [](Table& t, Rng&) { exchange(t, "x", "y"); }},
      {"sign_z", "position_axes", C::kBrisk, [](Table& t, Rng&) { scale(t, {"z"}, -1.0); }},
      {"compensated", "compensated", C::kEuler, [](Table& t, Rng&) { subtract_weight(t, 1.0); }},
      {"compensated_partly", "compensated", C::kBrisk,
       [](Table& t, Rng& rng) {
         subtract_weight(t, rng.uniform() < 0.5 ? rng.uniform(0.4, 0.7) : rng.uniform(1.5, 2.2));
       }},
      {"zeroed_before", "zeroed", C::kZeroedBefore, [](Table&, Rng&) {}},
      {"mounting", "mounting", C::kEuler, [](Table& t, Rng& rng) { remount(t, rng, 0.3, 0.7); }},
      {"mounting_small", "mounting", C::kEuler,
       [](Table& t, Rng& rng) { remount(t, rng, 0.17, 0.27); }},
      {"torque_mnm", "torque_unit", C::kTorque, [](Table& t, Rng&) { scale(t, kT, 1e3); }},
      {"torque_kgfcm", "torque_unit", C::kTorque,
       [](Table& t, Rng&) { scale(t, kT, 1.0 / 9.80665e-2); }},
      {"torque_reaction", "torque_sign", C::kTorque, [](Table& t, Rng&) { scale(t, kT, -1.0); }},
      {"torque_sign_y", "torque_sign", C::kTorque, [](Table& t, Rng&) { scale(t, {"ty"}, -1.0); }},
      {"torque_swap_xy", "torque_axes", C::kTorque,
       [](Table& t, Rng&) { exchange(t, "tx", "ty"); }},
      {"torque_base", "torque_frame", C::kTorque, [](Table& t, Rng&) { turn_to_base(t, kT); }},
      {"rates_deg", "rates", C::kRates, [](Table& t, Rng&) { scale(t, kW, kToDegrees); }},
      {"rates_base", "rates", C::kRates, [](Table& t, Rng&) { turn_to_base(t, kV); }},
      {"rates_sign", "rates", C::kRates, [](Table& t, Rng&) { scale(t, kW, -1.0); }},
      {"joint_deg", "angle_unit", C::kJoints,
       [](Table& t, Rng&) {
         scale(t, {"q_1", "q_2", "q_3", "qd_1", "qd_2", "qd_3"}, kToDegrees);
       }},
      {"joint_angles_deg", "angle_unit", C::kJoints,
       [](Table& t, Rng&) {
         scale(t, {"q_1", "q_2", "q_3"}, kToDegrees);
       }},
      {"joint_rates_deg", "rates", C::kJoints,
       [](Table& t, Rng&) {
         scale(t, {"qd_1", "qd_2", "qd_3"}, kToDegrees);
       }},
      {"joint_rates_sign", "rates", C::kJoints, [](Table& t, Rng&) { scale(t, {"qd_2"}, -1.0); }},
      {"power_sign", "power_sign", C::kJoints, [](Table& t, Rng&) { scale(t, {"tau_2"}, -1.0); }},
  };
  return kinds;
}

}  // namespace dcnn::conceal
