// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/first_order.h"
#include "physics/effect_law.h"

namespace dcnn::effects::lowpass {
namespace {

/// x' = (u - x)/tau of each column, from equilibrium, exact for an input linear between samples.
void filter(Eigen::MatrixXd& signals, const Motion& motion, double tau) {
  FirstOrder<double> lag(-1.0 / tau);
  for (Index i = 0; i < signals.cols() && signals.rows() > 0; ++i) {
    if (signals.col(i).isZero(0.0)) continue;  // two of three on a machine
    const Eigen::VectorXd u = signals.col(i) / tau;
    double x = signals(0, i);
    for (Index k = 1; k < signals.rows(); ++k) {
      signals(k, i) = x = lag.advance(x, u(k - 1), u(k), step(motion, k));
    }
  }
}

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  const double tau = parameter(parameters, "tau_s", 0.0);
  if (tau == 0.0) return;
  filter(wrench.force, motion, tau);
  filter(wrench.torque, motion, tau);
}

EffectStream stream(const EffectSpec&, Options& parameters) {
  const double tau = parameter(parameters, "tau_s", 0.0);
  if (tau == 0.0) return [](InstantWrench&, const Instant&) {};
  using Six = Eigen::Matrix<double, 6, 1>;
  return [tau, lag = FirstOrder<double>(-1.0 / tau), x = Six(Six::Zero()),
          before = Six(Six::Zero())](InstantWrench& wrench, const Instant& now) mutable {
    Six u;
    u << wrench.force, wrench.torque;
    for (Index i = 0; i < 6; ++i) {
      x(i) = now.first ? u(i) : lag.advance(x(i), before(i) / tau, u(i) / tau, now.dt);
    }
    before = u;
    wrench.force = x.head<3>();
    wrench.torque = x.tail<3>();
  };
}

Json numbers(const Eigen::VectorXd&, const Eigen::VectorXd& shapes) {
  return Json{{"tau_s", shapes(0)}};
}

}  // namespace

const EffectKind effect{
    .name = "lowpass",
    .stage = Stage::kDynamics,
    .kind = "sensor",
    .meaning = "first-order lag in the sensor",
    .on_machine = "first-order lag",
    .equation = "tau dF'/dt + F' = F",
    .example = R"({"tau_s": 0.01})",
    .needs_time = TimeNeed::kMotion,
    .lateness = "tau_s",
    .apply = apply,
    .stream = stream,
    // A drive's filters are faster than a tenth of a second; those of a sensor's driver need not
    // be.
    .fits = {{.shapes = {{"tau", 2e-5, 1.0, {1.5e-4, 0.001, 0.1, 0.004, 0.02, 0.5}}},
              .parameters = numbers,
              .use = EffectFit::Use::kTools},
             {.shapes = {{"tau", 2e-5, 0.1, {1.5e-4, 0.001, 0.004, 0.02}}},
              .parameters = numbers,
              .use = EffectFit::Use::kMachines}},
    .words =
        [](const FoundNumbers& n) {
          return (n.on_machine() ? "a lag with a time constant of "
                                 : "the sensor smooths with a time constant of ") +
                 in_thousandths(n.value("tau"), "ms");
        },
};

}  // namespace dcnn::effects::lowpass
