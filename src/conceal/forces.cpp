// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "conceal/draws.h"
#include "conceal/laws.h"
#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

Index letter(const std::string& s) { return s.back() - 'x'; }

/// A slug that slides with dry friction between stops that give way for some milliseconds.
VectorXd slug(const Parameters& p, const VectorXd& field) {
  constexpr double kStop = 630.0, kDamping = 0.35, kGrip = 0.3;  // rad/s, of critical, m/s^2
  VectorXd force(field.size());
  double s = -0.5 * p.at("gap_m") * (field(0) > 0.0 ? -1.0 : 1.0), v = 0.0;
  for (Index i = 0; i < field.size(); ++i) {
    const double beyond = std::abs(s) - 0.5 * p.at("gap_m");
    double a = field(i) - kGrip * elementary::tanh(v / 1e-3);
    if (beyond > 0.0) {
      a -= std::copysign(kStop * kStop * beyond, s) + 2.0 * kDamping * kStop * v;
    }
    force(i) = -p.at("slug_kg") * a;
    v += kStep * a;
    s += kStep * v;
  }
  return force;
}

/// Friction of a guide that the load presses on, or of a gear that transmits it.
VectorXd loaded(const Path& path, const Parameters& p, const Guide& g,
                const Eigen::MatrixXd& carried) {
  VectorXd f(g.v.size());
  for (Index i = 0; i < f.size(); ++i) {
    const double along_n = carried.row(i).dot(g.n.row(i)), square = carried.row(i).squaredNorm();
    const double across = std::sqrt(std::max(0.0, square - along_n * along_n));
    const double load = path.load.rows() > 0 ? std::abs(along_n) : across;
    f(i) = -p.at("mu") * load * elementary::tanh(g.v(i) / p.at("v0_mps"));
  }
  return f;
}

VectorXd geared(const Parameters& p, const Guide& g) {
  VectorXd f(g.v.size());
  for (Index i = 0; i < f.size(); ++i) {
    const double swell = p.at("a") * elementary::sin(p.at("order") * g.v(i) + p.at("phase_rad"));
    f(i) = -p.at("fc_n") * (1.0 + swell) * elementary::tanh(g.speed(i) / p.at("v0_mps"));
  }
  return f;
}

VectorXd along(const Path& path, const Hidden& h, const Guide& g, const Eigen::MatrixXd& field,
               const Eigen::MatrixXd& carried);

/// A law of strength a + slope T, T the temperature.
VectorXd driven(const Path& path, const Hidden& h, const Guide& g, const Eigen::MatrixXd& field,
                const Eigen::MatrixXd& carried) {
  Hidden unit = h;
  const double a = h.parameters.at(strength_of(h)), slope = h.parameters.at("slope");
  unit.parameters.erase("slope");
  unit.parameters[strength_of(h)] = 1.0;
  VectorXd f = along(path, unit, g, field, carried);
  for (Index i = 0; i < f.size(); ++i) f(i) *= a + slope * path.climate(path.time(i));
  return f;
}

VectorXd along(const Path& path, const Hidden& h, const Guide& g, const Eigen::MatrixXd& field,
               const Eigen::MatrixXd& carried) {
  const Parameters& p = h.parameters;
  if (p.count("slope") != 0) return driven(path, h, g, field, carried);
  if (h.effect == "load_friction") return loaded(path, p, g, carried);
  if (h.effect == "gear_friction") return geared(p, g);
  if (h.effect == "lugre_friction") return -lugre(h, g.v);
  if (h.effect == "drifting_lugre") return -lugre(h, g.v);
  if (h.effect == "hysteresis") return -bouc_wen(h, g.v);
  if (h.effect == "loose_load") return slug(p, field.col(letter(h.axis)));
  VectorXd f(g.v.size());
  for (Index i = 0; i < f.size(); ++i) {
    const double v = g.v(i), x = path.pose(i, 0) - 0.5, load = field.row(i).norm();
    if (h.effect == "cable_spring")
      f(i) = -p.at("k_nprad") * (v - p.at("rest_rad"));
    else if (h.effect == "cogging") {
      f(i) = p.at("amp_n") * elementary::sin(p.at("order") * v + p.at("phase_rad"));
    } else if (h.effect == "pose_modulated_friction") {
      f(i) = -p.at("size") * elementary::tanh(v / 0.01) *
             (1.0 + 0.9 * elementary::sin(9.0 * x / 0.12));
    } else if (h.effect == "velocity_position")
      f(i) = -p.at("size") * v * x * 30.0;
    else if (h.effect == "quadratic_spring") {
      f(i) = -p.at("k2_nprad2") * elementary::pow(v - p.at("rest_rad"), 2);
    } else if (h.effect == "square_load_friction") {
      f(i) = -p.at("size") * elementary::tanh(v / 0.01) *
             elementary::pow(std::abs(field(i, 2)) / load, 2);
    } else if (h.effect == "cubic_spring")
      f(i) = -p.at("size") * elementary::pow(h.axis[0] == 'g' ? v - std::numbers::pi : v, 3);
    else if (h.effect == "gravity_square")
      f(i) = p.at("size") * field(i, 0) * field(i, 1);
    else
      f(i) = -friction(h, v);
  }
  return f;
}

/// 1 while the force is on; a foreign contact rises and falls over a quarter of a second.
double pressed(const Hidden& h, double t) {
  if (h.effect == "event_train") return std::fmod(t * (1.0 + 0.01 * t), 3.1) < 0.5 ? 1.0 : 0.0;
  const auto [a, b] = *h.interval_s;
  if (t < a || t > b) return 0.0;
  return h.foreign ? std::min(1.0, std::min(t - a, b - t) / 0.25) : 1.0;
}

void press(const Path& path, const Hidden& h, Eigen::MatrixXd& F) {
  const Eigen::Vector3d f(h.parameters.at("force_x_n"), h.parameters.at("force_y_n"),
                          h.parameters.at("force_z_n"));
  for (Index i = 0; i < path.samples(); ++i) {
    const Eigen::Matrix3d& R = path.rotation[static_cast<std::size_t>(i)];
    F.row(i) += pressed(h, path.time(i)) * (R.transpose() * f).transpose();
  }
}

}  // namespace

std::string strength_of(const Hidden& h) {
  return h.effect == "cable_spring"       ? "k_nprad"
         : h.effect == "viscous_friction" ? "c_nspm"
                                          : "fc_n";
}

Guide guide(const Path& path, const std::string& axis) {
  const Index n = path.samples();
  Guide g{Eigen::MatrixXd::Zero(n, 3), VectorXd::Zero(n), VectorXd::Zero(n)};
  const auto colon = axis.find(':');
  const bool base = axis.rfind("base_", 0) == 0, spin = axis.rfind("w_sensor_", 0) == 0;
  for (Index i = 0; i < n; ++i) {
    const Eigen::Matrix3d& R = path.rotation[static_cast<std::size_t>(i)];
    if (base)
      g.n.row(i) = R.row(letter(axis));
    else
      g.n(i, letter(axis)) = 1.0;
    g.speed(i) = spin ? path.rate(i, letter(axis)) : (path.velocity.row(i) * R).dot(g.n.row(i));
    g.v(i) = g.speed(i);
    if (colon != std::string::npos) {
      g.v(i) = path.pose(i, axis[0] == 'a' ? 3 : (axis[0] == 'b' ? 4 : 5));
    }
  }
  return g;
}

void add_force(const Path& path, const Hidden& h, const Eigen::MatrixXd& field,
               const Eigen::MatrixXd& carried, Eigen::MatrixXd& F) {
  if (h.effect == "contact" || h.effect == "event_train") return press(path, h, F);
  if (is_drawn_law(h.effect)) return add_drawn_law(path, h, field, F);
  if (h.axis.empty() || h.effect == "flexible_resonance" || h.effect == "saturation" ||
      h.effect == "two_modes") {
    return;
  }
  const Guide g = guide(path, h.axis);
  F += g.n.cwiseProduct(along(path, h, g, field, carried).replicate(1, 3));
}

}  // namespace dcnn::conceal
