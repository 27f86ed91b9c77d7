// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "dcnn/physics/first_order.h"
#include "physics/effect_law.h"

namespace dcnn::effects::creep {
namespace {

/// Adds a·s to each column, s' = (F - s)/tau from equilibrium, exact for an input linear between
/// samples.
void relax(Eigen::MatrixXd& signals, const Motion& motion, double a, double tau) {
  FirstOrder<double> lag(-1.0 / tau);
  for (Index i = 0; i < signals.cols() && signals.rows() > 0; ++i) {
    const Eigen::VectorXd u = signals.col(i) / tau;
    double s = signals(0, i);
    signals(0, i) += a * s;
    for (Index k = 1; k < signals.rows(); ++k) {
      s = lag.advance(s, u(k - 1), u(k), step(motion, k));
      signals(k, i) += a * s;
    }
  }
}

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  const double a = parameter(parameters, "a"), tau = parameter(parameters, "tau_s", kTiny);
  relax(wrench.force, motion, a, tau);
  relax(wrench.torque, motion, a, tau);
}

EffectStream stream(const EffectSpec&, Options& parameters) {
  const double a = parameter(parameters, "a"), tau = parameter(parameters, "tau_s", kTiny);
  using Six = Eigen::Matrix<double, 6, 1>;
  return [a, tau, lag = FirstOrder<double>(-1.0 / tau), s = Six(Six::Zero()),
          before = Six(Six::Zero())](InstantWrench& wrench, const Instant& now) mutable {
    Six u;
    u << wrench.force, wrench.torque;
    for (Index i = 0; i < 6; ++i) {
      s(i) = now.first ? u(i) : lag.advance(s(i), before(i) / tau, u(i) / tau, now.dt);
    }
    before = u;
    wrench.force += a * s.head<3>();
    wrench.torque += a * s.tail<3>();
  };
}

}  // namespace

// Bounds: faster it is a low-pass, slower a drift; a sensor that settles to more than twice its
// first reading, or to less than none, is no sensor.
const EffectKind effect{
    .name = "creep",
    .stage = Stage::kDynamics,
    .kind = "sensor",
    .meaning = "reading that goes on settling after a load (standard linear solid)",
    .equation = "s' = (F - s)/tau, F -> F + a s",
    .example = R"({"a": 0.03, "tau_s": 8.0})",
    .needs_time = TimeNeed::kMotion,
    .special = true,
    .begins_anywhere = true,
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 1,
              .most_strength = 1.0,
              .shapes = {{"tau", 0.5, 300.0, {2.0, 8.0, 40.0}}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"a", a(0)}, {"tau_s", s(0)}};
                  }}},
    .is_itself = [](const Eigen::VectorXd& a, bool) { return std::abs(a(0)) < 1.0; },
    .words =
        [](const FoundNumbers& n) {
          return (n.on_machine() ? "a reading that goes on settling by "
                                 : "the sensor goes on settling after a load, by ") +
                 n.plain("a", 100.0) + " % within " + n("tau");
        },
};

}  // namespace dcnn::effects::creep
