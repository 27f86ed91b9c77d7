#include <cmath>

#include "conceal/laws.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

Index letter(const std::string& s) { return s.back() - 'x'; }

double friction(const std::string& id, const Parameters& p, double v) {
  if (id == "viscous_friction") return p.at("c_nspm") * v;
  if (id == "quadratic_drag") return p.at("c2_ns2pm2") * v * std::abs(v);
  const double sign = std::tanh(v / p.at("v0_mps"));
  if (id == "coulomb_friction") return p.at("fc_n") * sign;
  const double u = v / p.at("vs_mps");
  return (p.at("fc_n") + (p.at("fs_n") - p.at("fc_n")) * std::exp(-u * u)) * sign;
}

/// Runge and Kutta's fourth order for z' = f(z, drive), drive linear within a step.
template <class F>
double rk4(double z, double h, const F& f) {
  const double a = f(z, 0.0), b = f(z + 0.5 * h * a, 0.5), c = f(z + 0.5 * h * b, 0.5),
               d = f(z + h * c, 1.0);
  return z + h * (a + 2.0 * b + 2.0 * c + d) / 6.0;
}

VectorXd lugre(const Parameters& p, const VectorXd& v, double drift) {
  VectorXd force(v.size());
  double z = 0.0;
  for (Index i = 0; i < v.size(); ++i) {
    const double fc =
        p.at("fc_n") * (1.0 + drift * std::sin(0.002 * kStep * 1000.0 * static_cast<double>(i)));
    const double stiff = p.at("sigma0_npm") / fc;
    force(i) = p.at("sigma0_npm") * z + p.at("sigma1_nspm") * (v(i) - std::abs(v(i)) * z * stiff);
    const double next = v(std::min(i + 1, v.size() - 1));
    for (int k = 0; k < 4; ++k) {
      z = rk4(z, kStep / 4.0, [&](double x, double part) {
        const double now = v(i) + (next - v(i)) * (k + part) / 4.0;
        return now - std::abs(now) * x * stiff;
      });
    }
  }
  return force;
}

VectorXd bouc_wen(const Parameters& p, const VectorXd& q) {
  VectorXd force(q.size());
  double z = 0.0;
  for (Index i = 0; i < q.size(); ++i) {
    force(i) = p.at("force_n") * z;
    const double dq = (q(std::min(i + 1, q.size() - 1)) - q(i)) / p.at("width_rad");
    const double sign = dq > 0.0 ? 1.0 : (dq < 0.0 ? -1.0 : 0.0), asym = p.at("asym");
    z = rk4(z, 1.0, [&](double x, double) {
      return dq * (1.0 - (1.0 - asym) * sign * x - asym * std::abs(x));
    });
  }
  return force;
}

/// A slug that slides with dry friction between stops that give way for some milliseconds.
VectorXd slug(const Parameters& p, const VectorXd& field) {
  constexpr double kStop = 630.0, kDamping = 0.35, kGrip = 0.3;  // rad/s, of critical, m/s^2
  VectorXd force(field.size());
  double s = -0.5 * p.at("gap_m") * (field(0) > 0.0 ? -1.0 : 1.0), v = 0.0;
  for (Index i = 0; i < field.size(); ++i) {
    const double beyond = std::abs(s) - 0.5 * p.at("gap_m");
    double a = field(i) - kGrip * std::tanh(v / 1e-3);
    if (beyond > 0.0) {
      a -= std::copysign(kStop * kStop * beyond, s) + 2.0 * kDamping * kStop * v;
    }
    force(i) = -p.at("slug_kg") * a;
    v += kStep * a;
    s += kStep * v;
  }
  return force;
}

VectorXd along(const Path& path, const Hidden& h, const Guide& g, const Eigen::MatrixXd& field) {
  const Parameters& p = h.parameters;
  if (h.effect == "lugre_friction") return -lugre(p, g.v, 0.0);
  if (h.effect == "drifting_lugre") return -lugre(p, g.v, 0.6);
  if (h.effect == "hysteresis") return -bouc_wen(p, g.v);
  if (h.effect == "loose_load") return slug(p, field.col(letter(h.axis)));
  VectorXd f(g.v.size());
  for (Index i = 0; i < f.size(); ++i) {
    const double v = g.v(i), x = path.pose(i, 0) - 0.5, load = field.row(i).norm();
    if (h.effect == "cable_spring")
      f(i) = -p.at("k_nprad") * (v - p.at("rest_rad"));
    else if (h.effect == "cogging") {
      f(i) = p.at("amp_n") * std::sin(p.at("order") * v + p.at("phase_rad"));
    } else if (h.effect == "pose_modulated_friction") {
      f(i) = -p.at("size") * std::tanh(v / 0.01) * (1.0 + 0.9 * std::sin(9.0 * x / 0.12));
    } else if (h.effect == "velocity_position")
      f(i) = -p.at("size") * v * x * 30.0;
    else if (h.effect == "load_friction") {
      f(i) = -p.at("size") * std::tanh(v / 0.01) * std::pow(std::abs(field(i, 2)) / load, 2.0);
    } else if (h.effect == "cubic_spring")
      f(i) = -p.at("size") * v * v * v;
    else if (h.effect == "gravity_square")
      f(i) = p.at("size") * field(i, 0) * field(i, 1);
    else
      f(i) = -friction(h.effect, p, v);
  }
  return f;
}

}  // namespace

Guide guide(const Path& path, const std::string& axis) {
  const Index n = path.samples();
  Guide g{Eigen::MatrixXd::Zero(n, 3), VectorXd::Zero(n)};
  const auto colon = axis.find(':');
  const bool base = axis.rfind("base_", 0) == 0, spin = axis.rfind("w_sensor_", 0) == 0;
  for (Index i = 0; i < n; ++i) {
    const Eigen::Matrix3d& R = path.rotation[static_cast<std::size_t>(i)];
    if (base)
      g.n.row(i) = R.row(letter(axis));
    else
      g.n(i, letter(axis)) = 1.0;
    g.v(i) = spin ? path.rate(i, letter(axis)) : (path.velocity.row(i) * R).dot(g.n.row(i));
    if (colon != std::string::npos) {
      g.v(i) = path.pose(i, axis[0] == 'a' ? 3 : (axis[0] == 'b' ? 4 : 5));
    }
  }
  return g;
}

bool add_force(const Path& path, const Hidden& h, const Eigen::MatrixXd& field,
               Eigen::MatrixXd& F) {
  const Index n = path.samples();
  if (h.effect == "contact" || h.effect == "event_train") {
    const bool train = h.effect == "event_train";
    const Eigen::Vector3d f(h.parameters.at("force_x_n"), h.parameters.at("force_y_n"),
                            h.parameters.at("force_z_n"));
    for (Index i = 0; i < n; ++i) {
      const double t = path.time(i);
      const bool on = train ? std::fmod(t * (1.0 + 0.01 * t), 3.1) < 0.5
                            : t >= h.interval_s->first && t <= h.interval_s->second;
      if (on) F.row(i) += (path.rotation[static_cast<std::size_t>(i)].transpose() * f).transpose();
    }
    return true;
  }
  if (h.axis.empty() || h.effect == "flexible_resonance" || h.effect == "saturation" ||
      h.effect == "two_modes") {
    return false;
  }
  const Guide g = guide(path, h.axis);
  F += g.n.cwiseProduct(along(path, h, g, field).replicate(1, 3));
  return true;
}

}  // namespace dcnn::conceal
