// SPDX-License-Identifier: Apache-2.0
// What a sensor of force and torque reads of the tool: a cloud of point masses, and the levers of
// hidden forces.
#include <cmath>

#include "conceal/draws.h"
#include "conceal/laws.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr int kBeads = 5;
constexpr double kArm = 0.1;  // m, of drawn torques over drawn forces

/// The axis of S along which a force acts, where that is one.
std::optional<Index> fixed_axis(const std::string& axis) {
  if (axis.find("base_") != std::string::npos) return std::nullopt;
  return axis.back() - 'x';
}

bool acts_at_a_point(const Hidden& h) {
  return !h.axis.empty() && !has("loose_load flexible_resonance saturation two_modes", h.effect);
}

void draw_lever(Hidden& h, Rng& rng) {
  const Vector3d drawn(rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05),
                       rng.uniform(-0.25, 0.25));
  const auto along = fixed_axis(h.axis);
  for (int i = 0; i < 3; ++i) {
    // Along the force a lever makes no torque.
    h.parameters[std::string("lever_") + "xyz"[i] + "_m"] = along == Index{i} ? 0.0 : drawn(i);
  }
}

/// Torques beside the forces <stem>_x<unit>…, <stem>_tx<with m>…
void draw_beside(Hidden& h, const std::string& stem, const std::string& per, Rng& rng) {
  if (h.parameters.count(stem + "x_n" + per) == 0) return;
  for (char a : {'x', 'y', 'z'}) {
    const double force = h.parameters.at(stem + a + "_n" + per);
    h.parameters[stem + "t" + a + "_nm" + per] = kArm * std::abs(force) * rng.normal();
  }
}

}  // namespace

void draw_body(Tool& tool, Rng& rng) {
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < kBeads; ++k) {
    Vector3d away(0.03 * rng.normal(), 0.03 * rng.normal(), 0.06 * rng.normal());
    if (k + 1 == kBeads) away = -sum;  // so that their centre is the tool's
    sum += away;
    tool.beads.emplace_back(tool.com + away);
  }
  for (int j = 0; j < 3; ++j) tool.bias_torque(j) = rng.uniform(-0.05, 0.05);
}

void draw_torques(Hidden& h, Rng& rng) {
  if (acts_at_a_point(h)) draw_lever(h, rng);
  for (const char* stem : {"force_", "delta_bias_", "step_", "a_", "sin_", "cos_"}) {
    draw_beside(h, stem, "", rng);
  }
  draw_beside(h, "rate_", "ps", rng);
  draw_beside(h, "k_", "pk", rng);
}

Eigen::Matrix3d inertia_of(const Tool& tool) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Vector3d& r : tool.beads) {
    sum += r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose();
  }
  return tool.mass / static_cast<double>(tool.beads.size()) * sum;
}

Eigen::MatrixXd rigid_torque(const Path& path, const Tool& nominal, const Tool& tool,
                             const Vector3d& gravity) {
  const Eigen::MatrixXd field = felt_field(path, gravity);
  const Vector3d shifted = tool.mass * tool.com - nominal.mass * nominal.com;
  const double each = nominal.mass / static_cast<double>(nominal.beads.size());
  Eigen::MatrixXd torque(path.samples(), 3);
  for (Index i = 0; i < torque.rows(); ++i) {
    const Eigen::Matrix3d& R = path.rotation[static_cast<std::size_t>(i)];
    const Vector3d w = path.rate.row(i), dw = path.rate_derivative.row(i);
    Vector3d a = field.row(i);
    if (tool.inertial == "none") a = R.transpose() * gravity;
    Vector3d sum = shifted.cross(a);
    for (const Vector3d& r : nominal.beads) {
      Vector3d own = a;
      if (tool.inertial == "full") own -= dw.cross(r) + w.cross(w.cross(r));
      sum += r.cross(each * own);
    }
    torque.row(i) = sum;
  }
  return torque;
}

void add_moment(const Path& path, const Hidden& h, const Eigen::MatrixXd& added,
                Eigen::MatrixXd& torque) {
  const Parameters& p = h.parameters;
  if (p.count("lever_x_m") > 0) {
    const Vector3d lever(p.at("lever_x_m"), p.at("lever_y_m"), p.at("lever_z_m"));
    for (Index i = 0; i < torque.rows(); ++i) {
      torque.row(i) += lever.cross(Vector3d(added.row(i).transpose())).transpose();
    }
  } else if (p.count("force_tx_nm") > 0) {
    const Vector3d push(p.at("force_x_n"), p.at("force_y_n"), p.at("force_z_n")),
        twist(p.at("force_tx_nm"), p.at("force_ty_nm"), p.at("force_tz_nm"));
    for (Index i = 0; i < torque.rows(); ++i) {  // as strong a part of both
      const Eigen::Matrix3d& R = path.rotation[static_cast<std::size_t>(i)];
      const double part = (added.row(i) * R.transpose()).dot(push) / push.squaredNorm();
      torque.row(i) += part * (R.transpose() * twist).transpose();
    }
  }
}

}  // namespace dcnn::conceal
