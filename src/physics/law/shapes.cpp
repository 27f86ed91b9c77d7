// SPDX-License-Identifier: Apache-2.0
// The shapes that factors of a law have.
#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "dcnn/physics/law.h"

namespace dcnn::law {
namespace {

constexpr double kLeastBase = 1e-6;  // of a power, where its exponent is negative
constexpr double kMostExponent = 50.0;

double power_of(double size, double p) {
  if (size == 0.0 && p >= 0.0) return 0.0;
  return elementary::pow(std::max(size, kLeastBase), p);
}

double linear(double u, double) { return u; }
double power(double u, double p) { return std::copysign(power_of(std::abs(u), p), u); }
double even_power(double u, double p) { return power_of(std::abs(u), p); }
double inverse_power(double u, double p) { return power_of(std::abs(u), -p); }
double one_sided(double u, double p) { return u > 0.0 ? power_of(u, p) : 0.0; }
double asymmetric(double u, double p) { return u > 0.0 ? u : p * u; }
double saturating(double u, double) { return elementary::tanh(u); }
double peaked(double u, double) { return u / (1.0 + u * u); }
double fading(double u, double) {
  return u * elementary::exp(-std::min(std::abs(u), kMostExponent));
}
double dead_band(double u, double) { return std::copysign(std::max(0.0, std::abs(u) - 1.0), u); }
double logarithmic(double u, double) { return std::copysign(elementary::log1p(std::abs(u)), u); }
double bump(double u, double) { return elementary::exp(-std::min(0.5 * u * u, kMostExponent)); }
double sine(double u, double) { return elementary::sin(u); }
double exponential(double u, double) {
  return elementary::exp(std::clamp(-u, -kMostExponent, kMostExponent));
}
double affine(double u, double p) { return 1.0 + p * u; }
double wavy(double u, double p) { return 1.0 + p * elementary::sin(u); }
double switched(double u, double p) { return 1.0 + 0.5 * p * (1.0 + elementary::tanh(u)); }
double step(double u, double) { return 0.5 * (1.0 + elementary::tanh(u)); }
double falling(double u, double p) {  // Stribeck's: 1 + p at rest, 1 far from it
  return 1.0 + p * elementary::exp(-std::min(u * u, kMostExponent));
}

}  // namespace

const std::vector<Shape>& shapes() {
  // name, f(u), p, bounds of p, scale fitted, centre fitted, sign of the scale matters, f, told at
  static const std::vector<Shape> list{
      {"linear", "u", "\\left(@\\right)", "", 0.0, 0.0, false, true, false, linear, 1.0},
      {"power", "sgn(u) |u|^p", "\\operatorname{sgn}(@)\\left|@\\right|^{#}", "power", 0.05, 8.0,
       false, true, false, power, 1.0},
      {"even_power", "|u|^p", "\\left|@\\right|^{#}", "power", 0.05, 8.0, false, true, false,
       even_power, 1.0},
      {"inverse_power", "|u|^(-p)", "\\left|@\\right|^{-#}", "power", 0.05, 8.0, false, true, false,
       inverse_power, 1.0},
      {"one_sided", "max(0, u)^p", "\\max\\left(0, @\\right)^{#}", "power", 0.05, 8.0, false, true,
       true, one_sided, 1.0},
      {"asymmetric", "max(0, u) + p min(0, u)", "\\left(\\max(0, @) + #\\min(0, @)\\right)",
       "ratio", -1e3, 1e3, false, true, false, asymmetric, 1.0},
      {"tanh", "tanh(u)", "\\tanh\\left(@\\right)", "", 0.0, 0.0, true, true, false, saturating},
      {"peaked", "u/(1 + u^2)", "\\frac{@}{1 + \\left(@\\right)^2}", "", 0.0, 0.0, true, true,
       false, peaked, 1.0},
      {"fading", "u exp(-|u|)", "@\\, e^{-\\left|@\\right|}", "", 0.0, 0.0, true, true, false,
       fading, 1.0},
      {"dead_band", "sgn(u) max(0, |u| - 1)",
       "\\operatorname{sgn}(@)\\max\\left(0, \\left|@\\right| - 1\\right)", "", 0.0, 0.0, true,
       true, false, dead_band, 2.0},
      {"log", "sgn(u) log(1 + |u|)",
       "\\operatorname{sgn}(@)\\ln\\left(1 + \\left|@\\right|\\right)", "", 0.0, 0.0, true, true,
       false, logarithmic, 1.0},
      {"gaussian", "exp(-u^2/2)", "e^{-\\frac{1}{2}\\left(@\\right)^2}", "", 0.0, 0.0, true, true,
       false, bump},
      {"sine", "sin(u)", "\\sin\\left(@\\right)", "", 0.0, 0.0, true, true, false, sine},
      {"exponential", "exp(-u)", "e^{-@}", "", 0.0, 0.0, true, false, true, exponential},
      {"affine", "1 + p u", "\\left(1 + #\\,@\\right)", "gain", -1e6, 1e6, false, false, false,
       affine},
      {"wavy", "1 + p sin(u)", "\\left(1 + #\\sin\\left(@\\right)\\right)", "gain", -1e6, 1e6, true,
       true, false, wavy},
      {"falling", "1 + p exp(-u^2)", "\\left(1 + #\\,e^{-\\left(@\\right)^2}\\right)", "gain", -1e6,
       1e6, true, true, false, falling},
      {"step", "(1 + tanh(u))/2", "\\frac{1}{2}\\left(1 + \\tanh\\left(@\\right)\\right)", "", 0.0,
       0.0, true, true, true, step},
      {"switched", "1 + p (1 + tanh(u))/2",
       "\\left(1 + \\frac{#}{2}\\left(1 + \\tanh\\left(@\\right)\\right)\\right)", "gain", -1e6,
       1e6, true, true, false, switched},
      {"curve", "curve(u)", "\\operatorname{curve}\\left(@\\right)", "", 0.0, 0.0, false, false,
       false, nullptr}};
  return list;
}

bool is_curve(std::size_t shape) { return shapes()[shape].value == nullptr; }

double curve_at(const double* values, std::size_t count, double u) {
  const double last = static_cast<double>(count - 1);
  const double place = std::clamp(0.5 * (u + 1.0) * last, 0.0, last);
  const auto k = std::min(static_cast<std::size_t>(place), count - 2);
  const double x = place - static_cast<double>(k);
  const double from = values[k], to = values[k + 1];
  const double before = k == 0 ? to - from : 0.5 * (to - values[k - 1]),
               after = k + 2 == count ? to - from : 0.5 * (values[k + 2] - from);
  const double bend = 3.0 * (to - from) - 2.0 * before - after,
               turn = before + after - 2.0 * (to - from);
  return from + x * (before + x * (bend + x * turn));
}

}  // namespace dcnn::law
