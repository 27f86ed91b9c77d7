// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "conceal/laws.h"
#include "core/elementary.h"
#include "dcnn/data/rotation.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

Eigen::Vector3d three(const Parameters& p, const std::string& a, const std::string& b) {
  return {p.at(a + "x" + b), p.at(a + "y" + b), p.at(a + "z" + b)};
}

VectorXd resonance(const VectorXd& u, double hz, double zeta, double step) {
  const double w = 2.0 * std::numbers::pi * hz;
  VectorXd y(u.size());
  double x = u(0), v = 0.0;
  for (Index i = 0; i < u.size(); ++i) {  // velocity Verlet, damping in the middle of the step
    y(i) = x;
    v += 0.5 * step * w * (w * (u(i) - x) - 2.0 * zeta * v);
    x += step * v;
    const double next = u(std::min(i + 1, u.size() - 1));
    v = (v + 0.5 * step * w * w * (next - x)) / (1.0 + zeta * w * step);
  }
  return y;
}

void lag(const Parameters& p, double step, Eigen::MatrixXd& F) {
  const double tau = p.at("tau_s"), keep = elementary::exp(-step / tau);
  Eigen::RowVectorXd y = F.row(0), before = F.row(0);
  for (Index i = 1; i < F.rows(); ++i) {  // exact for an input linear within the step
    const Eigen::RowVectorXd now = F.row(i), slope = (now - before) / step;
    y = now - slope * tau + (y - before + slope * tau) * keep;
    before = now;
    F.row(i) = y;
  }
}

/// The spring beside a dashpot that goes on giving way: s' = (F - s)/tau by the trapezoidal rule.
void settle(const Parameters& p, double step, Eigen::MatrixXd& F) {
  const double twice = 2.0 * p.at("tau_s");
  Eigen::RowVectorXd s = F.row(0), before = F.row(0);
  F.row(0) += p.at("a") * s;
  for (Index i = 1; i < F.rows(); ++i) {
    const Eigen::RowVectorXd now = F.row(i);
    s = ((twice - step) * s + step * (before + now)) / (twice + step);
    before = now;
    F.row(i) += p.at("a") * s;
  }
}

void shift(double delay, double step, Eigen::MatrixXd& F) {
  const Eigen::MatrixXd G = F;
  const double last = static_cast<double>(F.rows() - 1);
  for (Index i = 0; i < F.rows(); ++i) {
    const double at = std::clamp(static_cast<double>(i) - delay / step, 0.0, last);
    const Index k = std::min(static_cast<Index>(at), F.rows() - 2);
    F.row(i) = G.row(k) + (at - static_cast<double>(k)) * (G.row(k + 1) - G.row(k));
  }
}

void cross(const Parameters& p, Eigen::MatrixXd& F) {
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const std::string key = std::string("c_") + "xyz"[i] + "xyz"[j];
      if (p.count(key)) C(i, j) = p.at(key);
    }
  }
  F.leftCols(3) = (F.leftCols(3) * C.transpose()).eval();
}

Eigen::Matrix3d mounting(const Eigen::Vector3d& r) { return rotation_from_euler(r.reverse()); }

/// The numbers <before>x<after>…, and <before>tx<after with m>… where there are such.
Eigen::RowVectorXd six(const Parameters& p, const std::string& before, const std::string& per) {
  Eigen::RowVectorXd all = Eigen::RowVectorXd::Zero(p.count(before + "tx_nm" + per) > 0 ? 6 : 3);
  all.head(3) = three(p, before, "_n" + per);
  if (all.size() == 6) all.tail(3) = three(p, before + "t", "_nm" + per);
  return all;
}

Eigen::RowVectorXd offset(const Path& path, const Hidden& h, double t) {
  const Parameters& p = h.parameters;
  if (h.effect == "bias") return six(p, "delta_bias_", "");
  if (h.effect == "linear_drift") return six(p, "rate_", "ps") * t;
  if (h.effect == "step_bias") return (t >= h.interval_s->first ? 1.0 : 0.0) * six(p, "step_", "");
  if (h.effect == "hum") {
    const double phase = 2.0 * std::numbers::pi * p.at("freq_hz") * t;
    return elementary::sin(phase) * six(p, "sin_", "") +
           elementary::cos(phase) * six(p, "cos_", "");
  }
  if (p.count("t_ref_degc")) return (path.climate(t) - p.at("t_ref_degc")) * six(p, "k_", "pk");
  return (1.0 - elementary::exp(-t / p.at("tau_s"))) * six(p, "a_", "");
}

}  // namespace

void change_reading(const Path& path, const Hidden& h, Eigen::MatrixXd& F) {
  const Parameters& p = h.parameters;
  if (h.effect == "flexible_resonance" || h.effect == "two_modes") {
    const Index a = h.axis.back() - 'x';
    const VectorXd u = F.col(a);
    VectorXd extra = resonance(u, p.at("freq_hz"), p.at("zeta"), path.step) - u;
    if (h.effect == "two_modes")
      extra -= resonance(u, 1.7 * p.at("freq_hz"), p.at("zeta"), path.step) - u;
    F.col(a) += p.at("fraction") * extra;
  } else if (h.effect == "misalignment")
    for (Index first = 0; first < F.cols(); first += 3) {
      F.middleCols(first, 3) = (F.middleCols(first, 3) * mounting(three(p, "rot_", "_rad"))).eval();
    }
  else if (h.effect == "gain") {
    const Eigen::Vector3d factor = Eigen::Vector3d::Ones() + three(p, "gain_", "");
    F.leftCols(3) = (F.leftCols(3) * factor.asDiagonal()).eval();
  } else if (h.effect == "crosstalk")
    cross(p, F);
  else if (h.effect == "lowpass")
    lag(p, path.step, F);
  else if (h.effect == "creep")
    settle(p, path.step, F);
  else if (h.effect == "time_delay")
    shift(p.at("delay_s"), path.step, F);
  else if (h.effect == "bias" || h.effect == "linear_drift" || h.effect == "step_bias" ||
           h.effect == "hum" || h.effect == "thermal_drift") {
    for (Index i = 0; i < F.rows(); ++i) {
      const Eigen::RowVectorXd added = offset(path, h, path.time(i));
      F.row(i).head(added.size()) += added;
    }
  }
}

}  // namespace dcnn::conceal
