// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <complex>
#include <numbers>

#include "dcnn/physics/first_order.h"
#include "physics/effect_law.h"

namespace dcnn::effects::flexible_resonance {
namespace {

constexpr double kMostWithNoise = 1.5;  // of a tool that rings
const ShapeParameter kFrequency{
    .name = "freq", .low = 1.0, .high = 200.0, .peak = ShapeParameter::Peak::kNarrow};

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const double w0 = 2.0 * std::numbers::pi * parameter(parameters, "freq_hz", kTiny);
  const double zeta = parameter(parameters, "zeta", 0.0, 0.999);
  const double fraction = parameter(parameters, "fraction");
  // H = w0^2/((s-p)(s-p*)): twice the real part of one complex first-order filter.
  const std::complex<double> p(-zeta * w0, w0 * std::sqrt(1.0 - zeta * zeta));
  FirstOrder<std::complex<double>> mode(p);
  Eigen::VectorXd rigid = wrench.force.col(axis_index(spec.axis));
  std::complex<double> x = motion.samples() > 0 ? -rigid(0) / p : 0.0;  // in equilibrium
  for (Index k = 1; k < motion.samples(); ++k) {
    x = mode.advance(x, rigid(k - 1), rigid(k), step(motion, k));
    const double rung = w0 * w0 * x.imag() / p.imag();
    wrench.force(k, axis_index(spec.axis)) += fraction * (rung - rigid(k));
  }
}

EffectStream stream(const EffectSpec& spec, Options& parameters) {
  const double w0 = 2.0 * std::numbers::pi * parameter(parameters, "freq_hz", kTiny);
  const double zeta = parameter(parameters, "zeta", 0.0, 0.999);
  const double fraction = parameter(parameters, "fraction");
  const std::complex<double> p(-zeta * w0, w0 * std::sqrt(1.0 - zeta * zeta));
  return [=, i = axis_index(spec.axis), mode = FirstOrder<std::complex<double>>(p), before = 0.0,
          x = std::complex<double>()](InstantWrench& wrench, const Instant& now) mutable {
    const double rigid = wrench.force(i);
    x = now.first ? -rigid / p : mode.advance(x, before, rigid, now.dt);
    before = rigid;
    if (!now.first) wrench.force(i) += fraction * (w0 * w0 * x.imag() / p.imag() - rigid);
  };
}

Json numbers(const Eigen::VectorXd& amplitudes, const Eigen::VectorXd& shapes) {
  return Json{{"freq_hz", shapes(0)}, {"zeta", shapes(1)}, {"fraction", amplitudes(0)}};
}

}  // namespace

const EffectKind effect{
    .name = "flexible_resonance",
    .stage = Stage::kResonance,
    .kind = "structural",
    .meaning = "tool rings along an axis",
    .on_machine = "resonance",
    .equation = "F_n -> F_n + fraction (H-1) F_n, H = w0^2/(s^2+2 zeta w0 s+w0^2)",
    .example = R"({"freq_hz": 12.0, "zeta": 0.05, "fraction": 0.5})",
    .axis = AxisRule::kSensor,
    .needs_time = TimeNeed::kMotion,
    .apply = apply,
    .stream = stream,
    // What a mount lets through is no more than all. A machine's mode takes nothing off, and rings.
    .fits = {{.amplitudes = 1,
              .most_strength = 1.0,
              .shapes = {kFrequency, {"zeta", 2e-3, 0.9, {0.01, 0.03, 0.1}}},
              .parameters = numbers,
              .use = EffectFit::Use::kTools},
             {.amplitudes = 1,
              .non_negative = true,
              .most_strength = 1.0,
              .shapes = {kFrequency, {"zeta", 2e-3, 0.5, {0.01, 0.03, 0.1}}},
              .parameters = numbers,
              .use = EffectFit::Use::kMachines}},
    // No more than all of the tool rings, but for noise.
    .is_itself = [](const Eigen::VectorXd& a,
                    bool on_machine) { return on_machine || std::abs(a(0)) <= kMostWithNoise; },
    .words =
        [](const FoundNumbers& n) {
          return (n.on_machine() ? "a resonance at " : "the tool rings at ") + n("freq");
        },
};

}  // namespace dcnn::effects::flexible_resonance
