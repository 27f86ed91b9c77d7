#include "dcnn/runtime/guard.h"

#include <algorithm>

namespace dcnn {
namespace {

bool usable(const std::optional<Eigen::Vector3d>& force) { return force && force->allFinite(); }

}  // namespace

const char* name_of(RunState state) {
  switch (state) {
    case RunState::kWarmup:
      return "WARMUP";
    case RunState::kNetwork:
      return "NETWORK";
    case RunState::kPhysics:
      return "PHYSICS";
    case RunState::kHold:
      return "HOLD";
    case RunState::kFade:
      return "FADE";
    case RunState::kFault:
      return "FAULT";
  }
  return "FAULT";
}

RunState Guard::decide(bool network, bool physics) {
  if (state_ == RunState::kFault) return state_;
  if (cycles_ < limits_.warmup_cycles) {
    ++cycles_;
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

void Guard::approach(const Eigen::Vector3d& target) {
  for (int i = 0; i < 3; ++i) {
    const double wanted = std::clamp(target[i], -limits_.force_n, limits_.force_n);
    output_[i] += std::clamp(wanted - output_[i], -limits_.slew_n, limits_.slew_n);
    output_[i] = std::clamp(output_[i], -limits_.force_n, limits_.force_n);
  }
}

const Eigen::Vector3d& Guard::step(const Cycle& cycle) {
  const bool measured = cycle.measured.allFinite();
  const bool physics = measured && usable(cycle.physics);
  bool network = measured && cycle.in_envelope && usable(cycle.network);
  if (network && physics) {
    network = (*cycle.network - *cycle.physics).cwiseAbs().maxCoeff() <= limits_.disagreement_n;
  }
  state_ = decide(network, physics);
  if (state_ == RunState::kNetwork) approach(cycle.measured - *cycle.network);
  if (state_ == RunState::kPhysics) approach(cycle.measured - *cycle.physics);
  if (state_ == RunState::kFade || state_ == RunState::kFault) approach(Eigen::Vector3d::Zero());
  return output_;
}

void Guard::rearm() {
  if (state_ != RunState::kFault) return;
  state_ = RunState::kWarmup;
  cycles_ = bad_ = good_ = 0;
}

}  // namespace dcnn
