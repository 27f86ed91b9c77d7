// SPDX-License-Identifier: Apache-2.0
// What the motion does not show, and which motion would.
#include <cmath>
#include <cstdio>

#include "identification/estimates.h"

namespace dcnn::identification {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

// A number is shown where half its 95 % interval is below these: half the number itself, or what
// moves a tool's weight by as much as its size.
constexpr double kHalf = 0.5;              // of a mass or a moment of inertia
constexpr double kComReach = 0.05;         // m
constexpr double kTurn = 0.1;              // rad
constexpr double kWeight = 0.5;            // of the tool's weight, for an offset of the force
constexpr double kGood = 0.05;             // of the number: what the motion asked for would give
constexpr double kGoodCom = 0.005;         // m
constexpr double kNormal95 = 1.959963985;  // half a 95 % interval in standard deviations
constexpr double kGravity = 9.81;          // m/s²

template <class... Args>
std::string print(const char* format, Args... args) {
  char line[240];
  std::snprintf(line, sizeof line, format, args...);
  return line;
}

/// Rms of the angular acceleration in S about each axis, over all moving rows.
Vector3d turning(const std::vector<WristLog>& logs, const WristState& state) {
  Vector3d sum = Vector3d::Zero();
  double rows = 0.0;
  for (const WristLog& log : logs) {
    if (log.at_rest) continue;
    const MatrixXd dw = log.thinned(log.motion.dw_S) * state.R_SE.transpose();
    sum += dw.colwise().squaredNorm().transpose();
    rows += static_cast<double>(dw.rows());
  }
  return (sum / std::max(rows, 1.0)).cwiseSqrt();
}

double rows_of(const WristFit& fit) {
  double rows = 0.0;
  for (const WristColumns& c : fit.columns) rows += static_cast<double>(c.rows());
  return rows;
}

/// Rms that makes half a 95 % interval `wanted` in as many rows of this noise.
double needed_rms(const WristFit& fit, bool torque, double wanted) {
  const double noise = torque ? fit.residual_rms.tail(3).maxCoeff() : fit.residual_rms.maxCoeff();
  return kNormal95 * noise / (wanted * std::sqrt(std::max(rows_of(fit), 1.0)));
}

const char* kTilt =
    "tilt the tool: gravity must turn in the sensor by 60 degrees or more, about two axes";

std::string com_motion(const WristFit& fit, const Vector3d& rms, Index axis, double mass) {
  const std::string name(1, "xyz"[axis]);
  if (fit.layout.torque) {
    return "poses with gravity across the sensor's " + name + " axis";
  }
  const double now = std::max(rms[(axis + 1) % 3], rms[(axis + 2) % 3]);
  return print("log torques, or turn about an axis across the sensor's %s with an angular "
               "acceleration of %.2g rad/s^2 rms (these recordings: %.2g)",
               name.c_str(), std::max(needed_rms(fit, false, kGoodCom) / mass, 2.0 * now), now);
}

std::string inertia_motion(const WristFit& fit, const Vector3d& rms, const std::string& axes,
                           double size) {
  const Index a = axes[0] - 'x', b = axes[1] - 'x';
  const double now = std::max(rms[a], rms[b]);
  const double needed = std::max(needed_rms(fit, true, kGood * size), 2.0 * now);
  return print("turn about the sensor's %c axis with an angular acceleration of %.2g rad/s^2 rms "
               "(these recordings: %.2g)",
               axes[0], needed, now);
}

/// The size of a moment of inertia: the largest, where it is known better than by half; else that of
/// a point mass at the centre of mass and 5 cm around it.
double inertia_size(const std::vector<IdentifiedNumber>& estimates) {
  constexpr double kAround = 0.05;  // m
  double com = 0.0, size = 0.0;
  for (const char* axis : {"x", "y", "z"}) {
    com += std::pow(find_estimate(estimates, std::string("com_") + axis + "_m")->value, 2);
  }
  for (const char* d : {"xx", "yy", "zz"}) {
    const IdentifiedNumber* e = find_estimate(estimates, std::string("inertia_") + d + "_kgm2");
    if (e && e->high - e->low < e->value) size = std::max(size, e->value);
  }
  const double mass = find_estimate(estimates, "mass_kg")->value;
  return size > 0.0 ? size : mass * (com + kAround * kAround);
}

}  // namespace

void mark_shown(const std::vector<WristLog>& logs, const WristFit& fit,
                std::vector<IdentifiedNumber>& estimates) {
  const Vector3d rms = turning(logs, fit.state);
  const double mass = std::max(find_estimate(estimates, "mass_kg")->value, 1e-6);
  const double size = inertia_size(estimates);
  bool moments_shown = true;
  for (IdentifiedNumber& e : estimates) {
    const double half = 0.5 * (e.high - e.low);
    const std::string& n = e.name;
    if (n == "mass_kg") {
      e.shown = half < kHalf * std::abs(e.value);
      e.motion = kTilt;
    } else if (n.starts_with("com_")) {
      e.shown = half < kComReach;
      e.motion = com_motion(fit, rms, n[4] - 'x', mass);
    } else if (n.starts_with("inertia_")) {
      const std::string axes = n.substr(8, 2);
      const bool moment = axes[0] == axes[1];
      e.shown = half < kHalf * (moment ? std::abs(e.value) : size);
      if (moment) moments_shown = moments_shown && e.shown;
      // A product is one of the body whose moments are known.
      if (!moment) e.shown = e.shown && moments_shown;
      e.motion = inertia_motion(fit, rms, axes, size);
    } else if (n.starts_with("mounting_")) {
      e.shown = half < kTurn;
      e.motion = kTilt;
    } else {
      const double lever = n.starts_with("bias_t") ? kComReach : 1.0;
      e.shown = half < kWeight * mass * kGravity * lever;
      e.motion = kTilt;
    }
    if (e.shown) e.motion.clear();
  }
}

}  // namespace dcnn::identification
