// SPDX-License-Identifier: Apache-2.0
// The states that a coordinate drives, or a shape of it, sample by sample.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "dcnn/physics/law.h"

namespace dcnn::law {
namespace {

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

int numbers_of(Memory memory) {
  if (memory == Memory::kNone) return 0;
  const bool two = memory == Memory::kSecondOrder || memory == Memory::kThixotropic ||
                   memory == Memory::kLags || memory == Memory::kUnevenLag;
  return two ? 2 : 1;
}

bool is_of_time(Memory memory) {
  return memory == Memory::kLag || memory == Memory::kHighPass || memory == Memory::kLags ||
         memory == Memory::kUnevenLag || memory == Memory::kSecondOrder || memory == Memory::kDelay;
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
      remembered_(factor.remembered),
      lags_(factor.memory == Memory::kLags ? LagsRun(numbers[0], numbers[1]) : LagsRun(0.0, 1.0)),
      delay_(factor.memory == Memory::kDelay ? *numbers : 0.0),
      pole_(factor.memory == Memory::kSecondOrder ? pole_of(numbers[0], numbers[1]) : 0.0),
      swing_(pole_) {
  if (memory_ != Memory::kNone) size_ = *numbers;
  if (numbers_of(memory_) > 1) second_ = numbers[1];
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
    case Memory::kUnevenLag: {
      const double before = lag_.value();
      const double rising = lag_.step(q, size_, h, first);
      falling_.set(before);
      const double falling = falling_.step(q, second_, h, first);
      lag_.set(first || q > before ? rising : falling);
      return lag_.value();
    }
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
        s_ = is_rate_ ? 1.0 / (1.0 + second_ * std::abs(q) / size_) : 1.0;
      } else {
        s_ = thixotropic(s_, std::abs(moved) / h, h, size_, second_);
      }
      return s_;
    default:
      s_ = first ? 0.0 : dwell(s_, std::abs(moved), h, size_);
      return s_;
  }
}

double FactorRun::step(double q, double h, bool first) {
  const double in = remembered_ ? shaped(q) : q, s = state(in, h, first);
  before_ = in;
  return remembered_ ? s : shaped(s);
}

double FactorRun::shaped(double q) const {
  const double u = (q - centre_) / scale_;
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
