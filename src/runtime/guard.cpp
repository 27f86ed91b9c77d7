// SPDX-License-Identifier: Apache-2.0
#include "dcnn/runtime/guard.h"

#include <algorithm>
#include <cmath>

namespace dcnn {
namespace {

bool usable(const std::optional<Vector6d>& wrench) { return wrench && wrench->allFinite(); }

bool within(const Vector6d& wrench, double force, double torque) {
  return wrench.head<3>().cwiseAbs().maxCoeff() <= force &&
         wrench.tail<3>().cwiseAbs().maxCoeff() <= torque;
}

}  // namespace

const char* name_of(RunState state) {
  constexpr const char* kNames[] = {"WARMUP", "NETWORK", "PHYSICS", "HOLD", "FADE", "FAULT"};
  return kNames[static_cast<int>(state)];
}

const char* name_of(Reason reason) {
  constexpr const char* kNames[] = {"none",  "warmup",   "missing",   "not_finite", "clock",
                                    "gap",   "envelope", "singular",  "model",      "disagree",
                                    "limit", "overrun",  "returning", "latched"};
  return kNames[static_cast<int>(reason)];
}

/// Why the network cannot be followed in this cycle.
Reason Guard::judge(const Cycle& cycle, bool measured, bool physics) const noexcept {
  if (!measured && cycle.distrust == Reason::kNone) return Reason::kNotFinite;
  if (cycle.distrust != Reason::kNone) return cycle.distrust;
  if (!usable(cycle.network)) return Reason::kModel;
  if (!physics) return Reason::kNone;
  if (!within(*cycle.network - *cycle.physics, limits_.disagreement_n, limits_.disagreement_nm)) {
    return Reason::kDisagreement;
  }
  const bool bounded = within(cycle.measured - *cycle.network, limits_.force_n, limits_.torque_nm);
  return bounded || !within(cycle.measured - *cycle.physics, limits_.force_n, limits_.torque_nm)
             ? Reason::kNone
             : Reason::kLimit;
}

RunState Guard::decide(bool network, bool physics) noexcept {
  if (state_ == RunState::kFault) return state_;
  if (cycles_ < limits_.warmup_cycles) {
    if (network || physics) ++cycles_;
    return RunState::kWarmup;
  }
  if (network) {
    const bool sudden = state_ != RunState::kNetwork && state_ != RunState::kWarmup;
    good_ = std::min(good_ + 1, limits_.return_cycles);
    if (sudden && physics && good_ < limits_.return_cycles) network = false;
  } else {
    good_ = 0;
  }
  if (network || physics) {
    bad_ = 0;
    return network ? RunState::kNetwork : RunState::kPhysics;
  }
  ++bad_;
  if (bad_ <= limits_.hold_cycles) return RunState::kHold;
  return bad_ <= limits_.hold_cycles + limits_.fade_cycles ? RunState::kFade : RunState::kFault;
}

void Guard::approach(const Vector6d& target) noexcept {
  for (int i = 0; i < 6; ++i) {
    const double limit = i < 3 ? limits_.force_n : limits_.torque_nm;
    const double slew = i < 3 ? limits_.slew_n : limits_.slew_nm;
    const double wanted = std::clamp(target[i], -limit, limit);
    output_[i] += std::clamp(wanted - output_[i], -slew, slew);
    output_[i] = std::clamp(output_[i], -limit, limit);
    limited_ = limited_ || std::abs(output_[i] - target[i]) > 1e-9;
  }
}

const Vector6d& Guard::step(const Cycle& cycle) noexcept {
  const bool measured = cycle.measured.allFinite();
  const bool physics = measured && usable(cycle.physics);
  const Reason judged = judge(cycle, measured, physics);
  state_ = decide(measured && judged == Reason::kNone, physics);
  reason_ = state_ == RunState::kFault     ? Reason::kLatched
            : state_ == RunState::kNetwork ? Reason::kNone
            : judged != Reason::kNone      ? judged
            : state_ == RunState::kWarmup  ? Reason::kWarmup
                                           : Reason::kReturning;
  limited_ = false;
  if (state_ == RunState::kNetwork) approach(cycle.measured - *cycle.network);
  if (state_ == RunState::kPhysics) approach(cycle.measured - *cycle.physics);
  if (state_ == RunState::kFade || state_ == RunState::kFault) approach(Vector6d::Zero());
  return output_;
}

void Guard::rearm() noexcept {
  if (state_ != RunState::kFault) return;
  state_ = RunState::kWarmup;
  reason_ = Reason::kWarmup;
  cycles_ = bad_ = good_ = 0;
}

}  // namespace dcnn
