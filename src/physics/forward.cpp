// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/forward.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/elementary.h"
#include "dcnn/physics/streaming_simulator.h"

namespace dcnn {
namespace {

/// A signal between its samples: a sinc under a Blackman window of 32 samples.
class BetweenSamples {
 public:
  static constexpr Index kHalf = 16, kParts = 64;

  explicit BetweenSamples(const Eigen::VectorXd& x) : x_(x), kernels_(kParts + 1, 2 * kHalf) {
    for (Index part = 0; part <= kParts; ++part) {
      for (Index k = 0; k < 2 * kHalf; ++k) {
        const double u = double(part) / kParts + double(kHalf - 1 - k), pi = std::numbers::pi;
        const double w = 0.42 + 0.5 * elementary::cos(pi * u / kHalf) +
                         0.08 * elementary::cos(2.0 * pi * u / kHalf);
        const double sinc = u == 0.0 ? 1.0 : elementary::sin(pi * u) / (pi * u);
        kernels_(part, k) = std::abs(u) < kHalf ? w * sinc : 0.0;
      }
      kernels_.row(part) /= kernels_.row(part).sum();
    }
  }
  /// At `place` samples from the first; before it and after the last the value there.
  double operator()(double place) const {
    const double whole = std::floor(place);
    const double part = (place - whole) * kParts, below = std::floor(part);
    const auto at = static_cast<Index>(whole), low = static_cast<Index>(below);
    const double first = sum(at, low);
    return part == below ? first : first + (part - below) * (sum(at, low + 1) - first);
  }

 private:
  double sum(Index at, Index part) const {
    double total = 0.0;
    for (Index k = 0; k < 2 * kHalf; ++k) {
      const Index i = std::clamp<Index>(at - (kHalf - 1) + k, 0, x_.size() - 1);
      total += kernels_(part, k) * x_(i);
    }
    return total;
  }
  const Eigen::VectorXd& x_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> kernels_;
};

struct MovingState {
  double q = 0.0, v = 0.0, a = 0.0;
  std::vector<EffectStream> memory;
};

/// One run along a drive.
class ForwardRun {
 public:
  ForwardRun(const DrivenLaw& law, const Eigen::VectorXd& drive, double dt, double tolerance)
      : law_(law),
        drive_(drive),
        dt_(dt),
        tolerance_(tolerance),
        size_(std::max(drive.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min())),
        slope_(law.inertia),
        step_(dt) {}

  bool start(double position, double velocity, double drive) {
    now_ = {position, velocity, 0.0, law_.memory};
    largest_ = std::abs(position);
    auto begun = newmark(now_, 0.0, drive, true);
    if (begun) now_ = std::move(*begun);
    return begun.has_value();
  }
  /// From sample k - 1 to k; false where no step is short enough.
  bool to_sample(Index k) {
    const double end = dt_;
    for (double t = 0.0; end - t > 1e-9 * dt_;) {
      const double passed = pass(double(k - 1) * dt_ + t, end - t);
      if (!(passed > 0.0)) return false;
      t += passed;
    }
    return true;
  }
  const MovingState& now() const { return now_; }

 private:
  static constexpr double kShortest = 1.0 / 4096.0;  // step, of a sample
  static constexpr double kSolved = 1e-11;           // of the drive's size
  static constexpr int kMostSolves = 40;
  static constexpr double kSmall = 1.0 / 32.0;  // of the error allowed: the step is doubled

  /// What the drive would have to be for the acceleration at hand, less what it is.
  double excess(MovingState& state, double h, double drive, bool first) const {
    Instant instant;
    instant.first = first;
    instant.dt = h;
    instant.euler[0] = state.q;
    instant.v_B[0] = state.v;
    instant.a_B[0] = state.a;
    InstantWrench wrench;
    wrench.of_axis = true;
    wrench.force[0] = wrench.load[0] =
        -law_.sense * (law_.inertia * state.a + law_.damping * state.v + law_.stiffness * state.q +
                       law_.constant);
    for (EffectStream& act : state.memory) act(wrench, instant);
    return -law_.sense * wrench.force[0] - drive;
  }

  /// The state after h by the average of both ends' accelerations, the last one by secants.
  std::optional<MovingState> newmark(const MovingState& from, double h, double drive, bool first) {
    const auto tried = [&](double a, MovingState& state) {
      state.memory = from.memory;
      state.a = a;
      state.v = from.v + 0.5 * h * (from.a + a);
      state.q = from.q + h * from.v + 0.25 * h * h * (from.a + a);
      return excess(state, h, drive, first);
    };
    MovingState state, other;
    double miss = tried(from.a, state);
    for (int i = 0; i < kMostSolves; ++i) {
      if (std::abs(miss) <= kSolved * size_) return state;
      const double next = state.a - miss / slope_;
      if (next == state.a) return state;
      const double left = tried(next, other);
      if (!std::isfinite(left)) return std::nullopt;
      const double secant = (left - miss) / (next - state.a);
      if (secant > 0.0) slope_ = std::clamp(secant, 0.2 * slope_, 5.0 * slope_);
      miss = left;
      std::swap(state, other);
    }
    return std::nullopt;
  }

  /// One step of at most `most` from the time t; how long it was, 0 where none is short enough.
  double pass(double t, double most) {
    for (double h = std::min(step_, most);; step_ = h) {
      const auto drive_at = [&](double later) { return drive_((t + later) / dt_); };
      const auto whole = newmark(now_, h, drive_at(h), false);
      const auto half = whole ? newmark(now_, 0.5 * h, drive_at(0.5 * h), false) : std::nullopt;
      auto both = half ? newmark(*half, 0.5 * h, drive_at(h), false) : std::nullopt;
      const bool shortest = h < 1.5 * kShortest * dt_;
      if (!both) {
        if (shortest) return 0.0;
        h *= 0.5;
        continue;
      }
      // Newmark's error falls with h^2: halves leave a third of the difference.
      const double error = (both->q - whole->q) / 3.0;
      const double allowed = tolerance_ * std::max(largest_, std::abs(both->q));
      const bool turns = now_.v * both->v < 0.0 && std::abs(error) > kSmall * allowed;
      if (!shortest && std::abs(error) > allowed) {
        h *= 0.5;
      } else if (!shortest && turns && !cut_) {
        cut_ = true;  // once: what is left of the turn lies within the next step
        h = std::max(kShortest * dt_, h * now_.v / (now_.v - both->v));
      } else {
        cut_ = false;
        both->q += error;
        both->v += (both->v - whole->v) / 3.0;
        now_ = std::move(*both);
        largest_ = std::max(largest_, std::abs(now_.q));
        if (std::abs(error) < kSmall * allowed) step_ = std::min(2.0 * h, dt_);
        return std::isfinite(now_.q) ? h : 0.0;
      }
    }
  }

  const DrivenLaw& law_;
  BetweenSamples drive_;
  double dt_, tolerance_, size_, slope_, step_, largest_ = 0.0;
  bool cut_ = false;
  MovingState now_;
};

bool runs_forwards(const EffectSpec& effect) {
  const EffectKind* kind = find_effect(effect.effect);
  return kind && kind->stream && runs_online(effect) &&
         (kind->stage == Stage::kForce || kind->stage == Stage::kOffset);
}

}  // namespace

AxisMachine forward_part(AxisMachine machine, std::size_t axis,
                         std::vector<std::string>& left_out) {
  std::erase_if(machine.axes[axis].effects, [&](const EffectSpec& effect) {
    const bool leaves = !runs_forwards(effect);
    if (leaves) left_out.push_back(effect.effect);
    return leaves;
  });
  return machine;
}

ForwardAxis::ForwardAxis(const AxisMachine& machine, std::size_t axis, double dt, std::string where,
                         Exit exit)
    : law_{.sense = machine.axes[axis].sense}, dt_(dt), where_(std::move(where)) {
  const CorrectedAxis& corrected = machine.axes[axis];
  const Axis& own = machine.system.axes[axis];
  require(own.has_base && machine.system.arm.is_null(), exit, where_, ": axis '", own.name,
          "': only an axis with a 'base' of its own moves by its own drive alone");
  const auto names = base_names(machine.system, axis);
  for (std::size_t k = 0; k < corrected.columns.size(); ++k) {
    const std::string& name = names[static_cast<std::size_t>(corrected.columns[k])];
    const double c = corrected.coefficients(static_cast<Index>(k));
    double* place = name == "acceleration" ? &law_.inertia
                    : name == "velocity"   ? &law_.damping
                    : name == "position"   ? &law_.stiffness
                    : name == "constant"   ? &law_.constant
                                           : nullptr;
    require(place != nullptr, exit, where_, ": axis '", own.name, "': its base has '", name,
            "', which the motion does not make; simulate a base of position, velocity and "
            "acceleration");
    *place = c;
  }
  require(law_.inertia > 0.0, exit, where_, ": axis '", own.name,
          "': has no inertia above zero, so no drive moves it; add 'acceleration' to its base");
  for (const EffectKind* kind : effect_kinds()) {
    for (const EffectSpec& effect : corrected.effects) {
      if (effect.effect != kind->name) continue;
      require(runs_forwards(effect), exit, where_, ": its effect '", effect.effect,
              "' is no force that the motion at hand makes; leave it out");
      law_.memory.push_back(stream_of(effect, where_, exit));
    }
  }
}

Eigen::MatrixXd ForwardAxis::run(const Eigen::VectorXd& drive, double position, double velocity,
                                 double tolerance) const {
  ForwardRun run(law_, drive, dt_, tolerance);
  require(run.start(position, velocity, drive(0)), Exit::kData, where_,
          ": no acceleration solves its first sample");
  Eigen::MatrixXd motion(drive.size(), 2);
  motion.row(0) << position, velocity;
  for (Index k = 1; k < drive.size(); ++k) {
    require(run.to_sample(k), Exit::kData, where_, ": no step is short enough at sample ", k,
            "; the model's motion grows without bounds, or its law jumps");
    motion.row(k) << run.now().q, run.now().v;
  }
  return motion;
}

}  // namespace dcnn
