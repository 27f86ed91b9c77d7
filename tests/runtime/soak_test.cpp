// SPDX-License-Identifier: Apache-2.0
// Hours of cycles with faults drawn at random: no output leaves its limit or its slew, and good
// samples always end in service again. DCNN_SOAK_HOURS=24 is a day of simulated time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "dcnn/core/random.h"
#include "runtime/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

constexpr double kDt = 0.002;            // s
constexpr Index kRows = 6000;            // of motion, played forwards and backwards
constexpr std::uint64_t kMeanGap = 390;  // cycles between two faults: 10^5 in 24 h
constexpr Index kRecovery = 200;         // good cycles after which it serves again

enum Kind {
  kSilence,
  kNotANumber,
  kSpike,
  kJump,
  kBack,
  kAhead,
  kRepeat,
  kPose,
  kOverrun,
  kPush,
  kKinds
};
constexpr const char* kNamesOfKinds[] = {"silence",    "not a number", "spike",  "jump of force",
                                         "clock back", "clock ahead",  "repeat", "jump of pose",
                                         "overrun",    "push"};

/// What goes wrong, and for how many cycles.
struct Injection {
  Kind kind = kSilence;
  Index left = 0;
  double size = 0.0;
  int axis = 0;
};

class Soak {
 public:
  explicit Soak(std::uint64_t seed)
      : rng_(seed), compensator_(&identifier_, &simulator_, options(), "soak") {
    for (Index k = 0; k < kRows; ++k) samples_.push_back(test::sample_of(recording_, k));
  }

  void cycle() {
    if (fault_.left == 0 && rng_.below(kMeanGap) == 0) draw();
    OnlineSample sample = next();
    bool silent = false;
    if (fault_.left > 0) {
      --fault_.left;
      good_ = 0;
      silent = spoil(sample);
    } else {
      ++good_;
    }
    sample.rearm = state_ == RunState::kFault && rng_.below(50) == 0;
    judge(silent ? compensator_.miss() : compensator_.step(sample));
  }

  std::array<std::uint64_t, kKinds> drawn{};
  std::array<std::uint64_t, 6> states{};
  std::uint64_t broken = 0, stuck = 0;

 private:
  static CompensatorOptions options() {
    CompensatorOptions options = test::mounted_options();
    options.bias_seconds = 5.0;
    options.contact_n = 1.0;
    return options;
  }

  OnlineSample next() {
    const Index place = static_cast<Index>(cycles_++ % (2 * kRows - 2));
    OnlineSample sample =
        samples_[static_cast<std::size_t>(std::min(place, 2 * kRows - 2 - place))];
    time_ += kDt;
    sample.t = time_;
    return sample;
  }

  void draw() {
    fault_ = {static_cast<Kind>(rng_.below(kKinds)), 1, 0.0, static_cast<int>(rng_.below(3))};
    if (rng_.below(4) == 0) fault_.left = 1 + static_cast<Index>(rng_.below(300));
    fault_.size = std::pow(10.0, 6.0 * rng_.uniform() - 2.0) * (rng_.below(2) ? 1.0 : -1.0);
    ++drawn[fault_.kind];
    if (fault_.kind == kBack) time_ -= std::abs(fault_.size) * kDt;
    if (fault_.kind == kAhead) time_ += std::abs(fault_.size) * kDt;
  }

  /// True where no sample comes at all.
  bool spoil(OnlineSample& sample) {
    constexpr double kNone[] = {std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::infinity(), -1e308, 1e-310};
    switch (fault_.kind) {
      case kSilence:
        return true;
      case kNotANumber:
        (fault_.axis == 0   ? sample.wrench[1]
         : fault_.axis == 1 ? sample.position[2]
                            : sample.t) = kNone[rng_.below(4)];
        break;
      case kSpike:
        sample.wrench[fault_.axis] += fault_.size * rng_.normal();
        break;
      case kJump:
      case kPush:
        sample.wrench[fault_.axis] +=
            fault_.kind == kPush ? 5.0 * std::tanh(fault_.size) : fault_.size;
        break;
      case kRepeat:
        sample.t -= kDt * static_cast<double>(1 + rng_.below(3));
        break;
      case kPose:
        (fault_.axis == 0 ? (*sample.euler)[1] : sample.position[fault_.axis]) +=
            1e-3 * fault_.size;
        break;
      case kOverrun:
        compensator_.overrun();
        break;
      default:
        break;  // the clock has jumped
    }
    return false;
  }

  void judge(const OnlineResult& result) {
    const GuardLimits limits;
    const Vector6d change = (result.external - before_).cwiseAbs(),
                   size = result.external.cwiseAbs();
    broken += !result.external.allFinite() || !result.bias.allFinite() ||
              size.head<3>().maxCoeff() > limits.force_n ||
              size.tail<3>().maxCoeff() > limits.torque_nm ||
              change.head<3>().maxCoeff() > limits.slew_n * (1.0 + 1e-12) ||
              change.tail<3>().maxCoeff() > limits.slew_nm * (1.0 + 1e-12);
    before_ = result.external;
    state_ = result.state;
    ++states[static_cast<std::size_t>(state_)];
    // A fault waits for the operator; anything else serves after enough that is good.
    if (state_ == RunState::kFault) good_ = 0;
    stuck += good_ > kRecovery && state_ != RunState::kNetwork && state_ != RunState::kPhysics;
  }

  Rng rng_;
  Identifier identifier_ = test::trained();
  Simulator simulator_ = test::small_tool();
  Recording recording_ = test::free_motion(kRows);
  std::vector<OnlineSample> samples_;
  OnlineCompensator compensator_;
  Injection fault_;
  Vector6d before_ = Vector6d::Zero();
  RunState state_ = RunState::kWarmup;
  double time_ = 0.0;
  std::uint64_t cycles_ = 0;
  Index good_ = 0;
};

TEST(Soak, NoFaultLeavesTheLimitOrTheSlewAndServiceReturns) {
  const char* hours = std::getenv("DCNN_SOAK_HOURS");
  const double seconds = hours ? 3600.0 * std::atof(hours) : 1200.0 / (test::kSanitized ? 10 : 1);
  Soak soak(hours ? 24 : 1);
  for (auto left = static_cast<std::int64_t>(seconds / kDt); left > 0; --left) soak.cycle();
  EXPECT_EQ(soak.broken, 0U);
  EXPECT_EQ(soak.stuck, 0U);
  std::uint64_t faults = 0;
  for (int kind = 0; kind < kKinds; ++kind) {
    const auto count = soak.drawn[static_cast<std::size_t>(kind)];
    EXPECT_GT(count, 0U) << kNamesOfKinds[kind];
    faults += count;
  }
  std::printf("%.1f h, %llu faults; cycles", seconds / 3600.0,
              static_cast<unsigned long long>(faults));
  for (std::size_t k = 0; k < soak.states.size(); ++k) {
    EXPECT_GT(soak.states[k], 0U) << name_of(static_cast<RunState>(k));
    std::printf(" %s %llu", name_of(static_cast<RunState>(k)),
                static_cast<unsigned long long>(soak.states[k]));
  }
  std::printf("; beyond limit or slew %llu, without service %llu\n",
              static_cast<unsigned long long>(soak.broken),
              static_cast<unsigned long long>(soak.stuck));
}

}  // namespace
}  // namespace dcnn
