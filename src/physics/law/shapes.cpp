// The shapes that factors of a law have, and the states that a coordinate drives.
#include <algorithm>
#include <cmath>
#include <numbers>

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

/// States of which a mean is taken: a spectrum from its shortest to its longest time, or of widths.
constexpr std::size_t kSpread = 8;

/// ds = (dx - abs(dx) s)/width over dx, exactly: towards the sign of dx, exponential in the path.
double dahl(double s, double dx, double width) {
  const double end = dx < 0.0 ? -1.0 : 1.0;
  return end + (s - end) * elementary::exp(-std::abs(dx) / width);
}

/// Root of p^2 + 2 d w p + w^2 with a positive imaginary part, rad/s.
std::complex<double> pole_of(double hz, double damping) {
  const double w = 2.0 * std::numbers::pi * hz;
  return {-damping * w, w * std::sqrt(1.0 - damping * damping)};
}

/// s' = 1 - speed s/length over h at constant speed.
double dwell(double s, double path, double h, double length) {
  const double turns = path / length;
  if (turns < 1e-9) return s + h;
  const double settled = h / turns;
  return settled + (s - settled) * elementary::exp(-turns);
}

/// s' = (1 - s)/recovery - speed s/length over h at constant speed.
double thixotropic(double s, double speed, double h, double length, double recovery) {
  const double rate = 1.0 / recovery + speed / length;
  const double settled = 1.0 / (recovery * rate);
  return settled + (s - settled) * elementary::exp(-h * rate);
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

int numbers_of(Memory memory) {
  if (memory == Memory::kNone) return 0;
  const bool two =
      memory == Memory::kSecondOrder || memory == Memory::kThixotropic || memory == Memory::kLags;
  return two ? 2 : 1;
}

std::size_t numbers_of(const Factor& factor) {
  const std::size_t of_shape =
      is_curve(factor.shape) ? factor.nodes : *shapes()[factor.shape].extra != 0;
  return static_cast<std::size_t>(numbers_of(factor.memory)) + factor.centred + 1 + of_shape;
}

FactorRun::FactorRun(const Factor& factor, const double* numbers)
    : shape_(&shapes()[factor.shape]),
      memory_(factor.memory),
      is_rate_(coordinates()[factor.coordinate].is_rate),
      lags_(factor.memory == Memory::kLags ? LagsRun(numbers[0], numbers[1]) : LagsRun(0.0, 1.0)),
      delay_(factor.memory == Memory::kDelay ? *numbers : 0.0),
      pole_(factor.memory == Memory::kSecondOrder ? pole_of(numbers[0], numbers[1]) : 0.0),
      swing_(pole_) {
  if (memory_ != Memory::kNone) size_ = *numbers;
  if (memory_ == Memory::kThixotropic) recovery_ = numbers[1];
  if (memory_ == Memory::kPlays) plays_.resize(kSpread);
  if (memory_ == Memory::kSecondOrder) gain_ = std::norm(pole_) / pole_.imag();
  numbers += numbers_of(memory_);
  if (factor.centred) centre_ = *numbers++;
  scale_ = *numbers++;
  if (is_curve(factor.shape)) curve_.assign(numbers, numbers + factor.nodes);
  if (*shape_->extra) extra_ = *numbers;
}

double FactorRun::mean_of_plays(double q, bool first) {
  double sum = 0.0;
  for (std::size_t k = 0; k < plays_.size(); ++k) {
    const double width = size_ * (static_cast<double>(k) + 0.5) / static_cast<double>(kSpread);
    plays_[k] = first ? q : std::clamp(plays_[k], q - width, q + width);
    sum += plays_[k];
  }
  return sum / static_cast<double>(kSpread);
}

double FactorRun::state(double q, double h, bool first) {
  const double moved = is_rate_ ? 0.5 * h * (q + before_) : q - before_;
  switch (memory_) {
    case Memory::kNone:
      return q;
    case Memory::kLag:
      return lag_.step(q, size_, h, first);
    case Memory::kHighPass:
      return q - lag_.step(q, size_, h, first);
    case Memory::kPlay:
      s_ = first ? q : std::clamp(s_, q - size_, q + size_);
      return s_;
    case Memory::kPlays:
      return mean_of_plays(q, first);
    case Memory::kLags:
      return lags_.step(q, h, first);
    case Memory::kDahl:
      s_ = first ? 0.0 : dahl(s_, moved, size_);
      return s_;
    case Memory::kStop:
      s_ = first ? 0.0 : std::clamp(s_ + moved, -size_, size_);
      return s_ / size_;
    case Memory::kSecondOrder:
      x_ = first ? -q / pole_ : swing_.advance(x_, before_, q, h);
      return gain_ * x_.imag();
    case Memory::kDelay:
      return delay_.step(q, h, first);
    case Memory::kThixotropic:
      if (first) {  // as if it had moved so for long
        s_ = is_rate_ ? 1.0 / (1.0 + recovery_ * std::abs(q) / size_) : 1.0;
      } else {
        s_ = thixotropic(s_, std::abs(moved) / h, h, size_, recovery_);
      }
      return s_;
    default:
      s_ = first ? 0.0 : dwell(s_, std::abs(moved), h, size_);
      return s_;
  }
}

double FactorRun::step(double q, double h, bool first) {
  const double s = state(q, h, first);
  before_ = q;
  const double u = (s - centre_) / scale_;
  return curve_.empty() ? shape_->value(u, extra_) : curve_at(curve_.data(), curve_.size(), u);
}

LagsRun::LagsRun(double tau, double spread) {
  if (!(tau > 0.0)) return;
  lags_.resize(kSpread);
  for (std::size_t k = 0; k < kSpread; ++k) {
    const double place = (static_cast<double>(k) + 0.5) / static_cast<double>(kSpread) - 0.5;
    times_.push_back(tau * elementary::pow(spread, place));
  }
}

double LagsRun::step(double q, double h, bool first) {
  double sum = 0.0;
  for (std::size_t k = 0; k < lags_.size(); ++k) sum += lags_[k].step(q, times_[k], h, first);
  return sum / static_cast<double>(lags_.size());
}

DelayRun::DelayRun(double delay) : delay_(delay) {
  constexpr std::size_t kMostKept = 1024;
  if (delay > 0.0) ring_.resize(kMostKept);
}

double DelayRun::step(double q, double h, bool first) {
  now_ = first ? 0.0 : now_ + h;
  if (first) count_ = 0;
  // Two of them always remain, one on either side of the time that is asked for.
  const double then = now_ - delay_;
  while (count_ > 1 && kept(1).t <= then) {
    oldest_ = (oldest_ + 1) % ring_.size();
    --count_;
  }
  constexpr double kSpacing = 1e-3;  // of the delay
  if (count_ == 0 || now_ - kept(count_ - 1).t >= kSpacing * delay_) {
    ring_[(oldest_ + count_) % ring_.size()] = {now_, q};
    ++count_;
  }
  const Kept& a = kept(0);
  if (then <= a.t) return a.q;
  const Kept b = count_ > 1 ? kept(1) : Kept{now_, q};
  return b.t > a.t ? a.q + (b.q - a.q) * (then - a.t) / (b.t - a.t) : a.q;
}

template <class Value>
Value LagRun<Value>::step(const Value& q, double tau, double h, bool first) {
  if (std::abs(h - h_) > 1e-9 * h) {  // steps of a regular clock differ in their last digits
    // Exact for the line from the value before to q (Franklin, Powell and Workman 1998, 6.3.2).
    const double z = h / tau, fallen = -elementary::expm1(-z);
    h_ = h;
    decay_ = 1.0 - fallen;
    ramp_ = z < 1e-6 ? 0.5 * z : 1.0 - fallen / z;
  }
  s_ = first ? q : Value(decay_ * s_ + (1.0 - decay_ - ramp_) * before_ + ramp_ * q);
  before_ = q;
  return s_;
}
template double LagRun<double>::step(const double&, double, double, bool);
template Vector3d LagRun<Vector3d>::step(const Vector3d&, double, double, bool);

}  // namespace dcnn::law
