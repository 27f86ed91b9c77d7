// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "conceal/draws.h"
#include "conceal/faulty.h"
#include "core/elementary.h"
#include "dcnn/data/rotation.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
constexpr int kStride = 16;            // 250 Hz
constexpr double kTorqueNoise = 0.03;  // m, noise of torques over that of forces

Tool draw_any_tool(Rng& rng) {
  Tool tool;
  tool.mass = logarithmic(rng, 0.3, 2.5);
  tool.com = {rng.uniform(-0.02, 0.02), rng.uniform(-0.02, 0.02), rng.uniform(0.03, 0.18)};
  tool.bias = {rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0)};
  return tool;
}

/// Every second log has some friction that no rigid tool has.
std::vector<Hidden> draw_friction(Rng& rng) {
  if (rng.uniform() < 0.5) return {};
  Hidden friction{"coulomb_friction",
                  one_of<std::string>(rng, {"base_x", "base_y", "tool_z"}),
                  {},
                  {},
                  false,
                  0.0};
  friction.parameters = {{"fc_n", rng.uniform(0.05, 0.4)}, {"v0_mps", 0.01}};
  return {friction};
}

Path draw_any_path(CleanLog kind, Rng& rng) {
  auto motion = one_of<std::string>(rng, {"human", "multisine", "points", "scan", "repeats"});
  if (kind == CleanLog::kBrisk) motion = one_of<std::string>(rng, {"human", "points", "repeats"});
  const double seconds = kind == CleanLog::kStatic ? 60.0 : rng.uniform(12.0, 18.0);
  const Path path = make_path(kind == CleanLog::kStatic ? "points" : motion, 0.0, seconds,
                              {0.0, 0.0, 0.0}, {}, rng.bits());
  if (kind != CleanLog::kStill) return path;
  Eigen::MatrixXd pose = path.pose;
  std::vector<Eigen::Matrix3d> rotation;
  for (Index i = 0; i < pose.rows(); ++i) {
    for (Index j = 3; j < 6; ++j) pose(i, j) = pose(0, j) + 0.01 * (pose(i, j) - pose(0, j));
    rotation.push_back(rotation_from_euler(pose.row(i).tail<3>()));
  }
  return follow(0.0, pose, rotation, {0.0, 0.0, 0.0});
}

Json simulator_of(const Tool& tool, Rng& rng) {
  Json sim;  // nominal numbers: the mass is known to some 10 %
  sim["tool"]["mass_kg"] = tool.mass * rng.uniform(0.9, 1.1);
  sim["tool"]["com_m"] = Json{tool.com[0], tool.com[1], tool.com[2]};
  return sim;
}

void add_rates(const Path& path, Index rows, Rng& rng, Table& table) {
  Eigen::MatrixXd rates(rows, 6);
  for (Index i = 0; i < rows; ++i) {
    const Index k = i * kStride;
    const Eigen::Matrix3d& R = path.rotation[static_cast<std::size_t>(k)];
    rates.row(i) << path.velocity.row(k) * R, path.rate.row(k);
    for (Index j = 0; j < 6; ++j) rates(i, j) = rounded(rates(i, j) + 1e-3 * rng.normal(), 1e7);
  }
  Index j = 0;
  for (const char* name : {"vx", "vy", "vz", "wx", "wy", "wz"}) append(table, name, rates.col(j++));
}

void add_torques(const Eigen::MatrixXd& torque, double noise, Rng& rng, Table& table) {
  Index j = 0;
  for (const char* name : {"tx", "ty", "tz"}) {
    append(table, name, torque.col(j++).unaryExpr([&](double x) {
      return rounded(x + noise * rng.normal(), 1e7);
    }));
  }
}

void use_quaternion(Table& table) {
  Recording recording{"", table, 0.0, 0.0, {{0, table.values.rows()}}, false, {}};
  const Eigen::MatrixXd q = quaternions(recording);
  for (const char* name : {"alpha", "beta", "gamma"}) remove(table, name);
  Index j = 0;
  for (const char* name : {"qw", "qx", "qy", "qz"}) append(table, name, q.col(j++));
}

/// One row per second or so, in no order, without a clock.
void keep_poses(Rng& rng, Table& table) {
  std::vector<std::int64_t> order = permutation(table.values.rows(), rng);
  order.resize(static_cast<std::size_t>(20 + rng.below(30)));
  table.values = Eigen::MatrixXd(table.values(order, Eigen::all));
  remove(table, "t");
}

FaultyLog make_wrist(CleanLog kind, Rng& rng) {
  Tool tool = draw_any_tool(rng);
  const bool torques = kind == CleanLog::kTorque;
  if (torques) draw_body(tool, rng);
  if (kind == CleanLog::kZeroedBefore) {
    const Eigen::Vector3d down(rng.normal(), rng.normal(), rng.normal());
    tool.bias = -9.81 * tool.mass * down.normalized();
  }
  Path path = draw_any_path(kind, rng);
  if (kind == CleanLog::kStatic)
    path.acceleration.setZero(), path.rate.setZero(), path.rate_derivative.setZero();
  std::vector<Hidden> hidden =
      kind == CleanLog::kStatic ? std::vector<Hidden>{} : draw_friction(rng);
  for (Hidden& h : hidden) {
    if (torques) draw_torques(h, rng);
  }
  const Eigen::MatrixXd F = reading(path, tool, hidden, {}, kStride);
  const double noise = rng.uniform(0.02, 0.06), metres = logarithmic(rng, 5e-6, 5e-5),
               angles = logarithmic(rng, 5e-6, 1e-4);
  FaultyLog out{{{"t", "x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"},
                 Eigen::MatrixXd(F.rows(), 10)},
                simulator_of(tool, rng),
                nullptr,
                ""};
  for (Index i = 0; i < F.rows(); ++i) {
    out.table.values(i, 0) = rounded(path.time(i * kStride), 1e6);
    for (Index j = 0; j < 6; ++j) {
      out.table.values(i, 1 + j) =
          rounded(path.pose(i * kStride, j) + (j < 3 ? metres : angles) * rng.normal(), 1e8);
    }
    for (Index j = 0; j < 3; ++j)
      out.table.values(i, 7 + j) = rounded(F(i, j) + noise * rng.normal(), 1e6);
  }
  if (torques) add_torques(F.rightCols<3>(), kTorqueNoise * noise, rng, out.table);
  if (kind == CleanLog::kRates) add_rates(path, F.rows(), rng, out.table);
  if (kind == CleanLog::kQuaternion) use_quaternion(out.table);
  if (kind == CleanLog::kStatic) keep_poses(rng, out.table);
  return out;
}

/// Three joints, each with inertia, gravity and friction of its own, and a little of the others';
/// or three motors behind gears, which carry no weight and are logged in radians of their shafts.
FaultyLog make_joints(Rng& rng, bool motors) {
  const auto rows = static_cast<Index>(250.0 * rng.uniform(12.0, 18.0));
  const Eigen::VectorXd t =
      Eigen::VectorXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1) / 250.0);
  FaultyLog out{{{"t"}, t}, nullptr, nullptr, ""};
  Eigen::MatrixXd q(rows, 3), v(rows, 3), a(rows, 3), tau(rows, 3);
  q.setZero(), v.setZero(), a.setZero();
  for (Index j = 0; j < 3; ++j) {
    for (int k = 0; k < 4; ++k) {
      const double w = 2.0 * std::numbers::pi * logarithmic(rng, 0.1, 1.0),
                   p = rng.uniform(0.0, 6.28), size = 1.2 / (1.0 + w);
      for (Index i = 0; i < rows; ++i) {
        const double s = elementary::sin(w * t[i] + p), c = elementary::cos(w * t[i] + p);
        q(i, j) += size * s, v(i, j) += size * w * c, a(i, j) -= size * w * w * s;
      }
    }
  }
  for (Index j = 0; j < 3; ++j) {
    const double inertia = logarithmic(rng, 0.2, 2.0),
                 weight = motors ? 0.0 : rng.uniform(-20.0, 20.0), dry = rng.uniform(1.0, 6.0),
                 viscous = rng.uniform(0.5, 5.0);
    for (Index i = 0; i < rows; ++i) {
      tau(i, j) = inertia * (a(i, j) + 0.2 * a(i, (j + 1) % 3)) +
                  weight * elementary::sin(q(i, j)) + dry * elementary::tanh(v(i, j) / 0.02) +
                  viscous * v(i, j) + 0.2 * rng.normal();
    }
  }
  for (Index j = 0; j < 3; ++j) {
    const std::string number = std::to_string(j + 1);
    if (motors) {
      const double gear = logarithmic(rng, 20.0, 150.0);
      q.col(j) *= gear, v.col(j) *= gear;
    }
    append(out.table, "q_" + number,
           q.col(j).unaryExpr([&](double x) { return rounded(x + 2e-5 * rng.normal(), 1e7); }));
    append(out.table, "qd_" + number,
           v.col(j).unaryExpr([&](double x) { return rounded(x + 2e-3 * rng.normal(), 1e7); }));
    append(out.table, "tau_" + number,
           tau.col(j).unaryExpr([&](double x) { return rounded(x, 1e6); }));
  }
  return out;
}

}  // namespace

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

Index column_of(const Table& table, const std::string& name) {
  const auto it = std::find(table.columns.begin(), table.columns.end(), name);
  require(it != table.columns.end(), Exit::kUsage, "this fault needs a log with a column '", name,
          "'");
  return it - table.columns.begin();
}

Eigen::Ref<Eigen::VectorXd> column(Table& table, const std::string& name) {
  return table.values.col(column_of(table, name));
}

void append(Table& table, const std::string& name, const Eigen::VectorXd& values) {
  table.columns.push_back(name);
  table.values.conservativeResize(values.size(), table.values.cols() + 1);
  table.values.rightCols(1) = values;
}

void remove(Table& table, const std::string& name) {
  const Index k = column_of(table, name), after = table.values.cols() - k - 1;
  table.values.middleCols(k, after) = Eigen::MatrixXd(table.values.rightCols(after));
  table.values.conservativeResize(Eigen::NoChange, table.values.cols() - 1);
  table.columns.erase(table.columns.begin() + k);
}

FaultyLog make_clean(CleanLog kind, Rng& rng) {
  if (kind >= CleanLog::kArm) return make_arm(kind, rng);
  const bool motors = kind == CleanLog::kMotors;
  return motors || kind == CleanLog::kJoints ? make_joints(rng, motors) : make_wrist(kind, rng);
}

}  // namespace dcnn::conceal
