// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "conceal/laws.h"
#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Runge and Kutta's fourth order for z' = f(z, drive), drive linear within a step.
template <class F>
double rk4(double z, double h, const F& f) {
  const double a = f(z, 0.0), b = f(z + 0.5 * h * a, 0.5), c = f(z + 0.5 * h * b, 0.5),
               d = f(z + h * c, 1.0);
  return z + h * (a + 2.0 * b + 2.0 * c + d) / 6.0;
}

/// Iwan's elements: springs in series with sliders that give way one after the other; the share of
/// their sum at full slip. No rate in it, and an initial curve like that of LuGre or Bouc and Wen.
VectorXd sliders(const VectorXd& x, double reach) {
  constexpr double kGiveWay[4] = {0.3, 0.7, 1.2, 2.0};
  double spring[4] = {0.0, 0.0, 0.0, 0.0};
  VectorXd share = VectorXd::Zero(x.size());
  for (Index i = 1; i < x.size(); ++i) {
    for (int k = 0; k < 4; ++k) {
      const double limit = kGiveWay[k] * reach;
      spring[k] = std::clamp(spring[k] + x(i) - x(i - 1), -limit, limit);
      share(i) += 0.25 * spring[k] / limit;
    }
  }
  return share;
}

VectorXd travelled(const VectorXd& v, double step) {
  VectorXd x(v.size());
  double now = 0.0;
  for (Index i = 0; i < v.size(); ++i) x(i) = now += step * v(i);
  return x;
}

}  // namespace

double friction(const Hidden& h, double v) {
  const Parameters& p = h.parameters;
  const std::string& id = h.effect;
  if (id == "viscous_friction") return p.at("c_nspm") * v;
  if (id == "asymmetric_friction") return p.at("delta_c_nspm") * std::abs(v);
  if (id == "quadratic_drag") return p.at("c2_ns2pm2") * v * std::abs(v);
  const double u0 = v / p.at("v0_mps");
  const double sign = h.foreign ? u0 / std::sqrt(1.0 + u0 * u0) : elementary::tanh(u0);
  if (id == "coulomb_friction") return p.at("fc_n") * sign;
  const double u = v / p.at("vs_mps");
  return (p.at("fc_n") + (p.at("fs_n") - p.at("fc_n")) * elementary::exp(-u * u)) * sign;
}

VectorXd lugre(const Hidden& h, const VectorXd& v, double step) {
  const Parameters& p = h.parameters;
  if (h.foreign) {
    return p.at("fc_n") * sliders(travelled(v, step), p.at("fc_n") / p.at("sigma0_npm"));
  }
  const double drift = h.effect == "drifting_lugre" ? 0.6 : 0.0;
  VectorXd force(v.size());
  double z = 0.0;
  for (Index i = 0; i < v.size(); ++i) {
    const double fc =
        p.at("fc_n") *
        (1.0 + drift * elementary::sin(0.002 * step * 1000.0 * static_cast<double>(i)));
    const double stiff = p.at("sigma0_npm") / fc;
    force(i) = p.at("sigma0_npm") * z + p.at("sigma1_nspm") * (v(i) - std::abs(v(i)) * z * stiff);
    const double next = v(std::min(i + 1, v.size() - 1));
    for (int k = 0; k < 4; ++k) {
      z = rk4(z, step / 4.0, [&](double x, double part) {
        const double now = v(i) + (next - v(i)) * (k + part) / 4.0;
        return now - std::abs(now) * x * stiff;
      });
    }
  }
  return force;
}

VectorXd bouc_wen(const Hidden& h, const VectorXd& q) {
  const Parameters& p = h.parameters;
  if (h.foreign) return p.at("force_n") * sliders(q, p.at("width_rad"));
  const auto given = [&](const char* name, double otherwise) {
    return p.count(name) ? p.at(name) : otherwise;
  };
  const double asym = given("asym", 0.5), m = given("m", 1.0);
  const double beta = given("beta", 1.0 - asym), gamma = given("gamma", asym);
  VectorXd force(q.size());
  double z = 0.0;
  for (Index i = 0; i < q.size(); ++i) {
    force(i) = p.at("force_n") * z;
    const double dq = (q(std::min(i + 1, q.size() - 1)) - q(i)) / p.at("width_rad");
    const double sign = dq > 0.0 ? 1.0 : (dq < 0.0 ? -1.0 : 0.0);
    z = rk4(z, 1.0, [&](double x, double) {
      const double bend = m == 1.0 ? 1.0 : elementary::pow(std::abs(x), m - 1.0);
      return dq * (1.0 - (beta * sign * x + gamma * std::abs(x)) * bend);
    });
  }
  return force;
}

}  // namespace dcnn::conceal
