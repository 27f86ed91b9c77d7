// SPDX-License-Identifier: Apache-2.0
#include "dcnn/runtime/compensator.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "dcnn/core/random.h"
#include "runtime/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

constexpr Index kWarm = 60;

struct World {
  Identifier identifier = test::trained();
  Simulator simulator = test::small_tool();
  Recording recording = test::free_motion(6000);
  std::vector<OnlineSample> samples;
  World() {
    for (Index k = 0; k < 6000; ++k) samples.push_back(test::sample_of(recording, k));
  }
  OnlineCompensator compensator(CompensatorOptions options = test::mounted_options()) const {
    return {&identifier, &simulator, options, "test"};
  }
};

const World& world() {
  static const World shared;
  return shared;
}

TEST(Compensator, WhatIsLeftIsTheExternalForceInTheRobotsFrame) {
  auto compensator = world().compensator();
  const Vector3d touch(1.0, -2.0, 3.0);
  double squares = 0.0;
  for (Index k = 0; k < 3000; ++k) {
    const bool touching = k >= 1500;
    const auto& result = compensator.step(
        test::sample_of(world().recording, k, touching ? touch : Vector3d::Zero()));
    if (k < kWarm || (touching && k < 1520)) continue;
    ASSERT_EQ(result.state, RunState::kNetwork) << k << " " << name_of(result.reason);
    squares += (result.external.head<3>() - (touching ? touch : Vector3d::Zero())).squaredNorm();
    if (k > 1600) {
      ASSERT_TRUE(result.contact) << k;
    } else if (k < 1500) {
      ASSERT_FALSE(result.contact) << k;
    }
  }
  EXPECT_LT(std::sqrt(squares / 3.0 / 2900.0), 0.15);
}

TEST(Compensator, QuaternionAndEulerAnglesGiveTheSame) {
  auto a = world().compensator(), b = world().compensator();
  for (Index k = 0; k < 200; ++k) {
    OnlineSample sample = test::sample_of(world().recording, k);
    const Vector6d first = a.step(sample).external;
    sample.euler.reset();
    ASSERT_LT((b.step(sample).external - first).norm(), 1e-6) << k;
  }
}

TEST(Compensator, ASimulatorAloneServesInPhysics) {
  OnlineCompensator compensator(nullptr, &world().simulator, test::mounted_options(), "test");
  double worst = 0.0;
  for (Index k = 0; k < 500; ++k) {
    const auto& result = compensator.step(test::sample_of(world().recording, k));
    if (k < kWarm) continue;
    ASSERT_EQ(result.state, RunState::kPhysics);
    worst = std::max(worst, result.external.norm());
  }
  EXPECT_LT(worst, 0.5);
}

TEST(Compensator, MotionUnlikeTrainingIsPhysicsInTheSameCycle) {
  auto compensator = world().compensator();
  for (Index k = 0; k < 300; ++k) compensator.step(test::sample_of(world().recording, k));
  Index first = -1;
  for (Index k = 300; k < 400 && first < 0; ++k) {  // shakes
    OnlineSample sample = test::sample_of(world().recording, k);
    sample.position[0] += 0.02 * std::sin(0.3 * static_cast<double>(k - 300));
    const auto& result = compensator.step(sample);
    if (result.novelty <= 1.0) continue;
    first = k;
    EXPECT_EQ(result.state, RunState::kPhysics);
    EXPECT_EQ(result.reason, Reason::kEnvelope);
  }
  ASSERT_GE(first, 300);
  EXPECT_LT(first, 325);  // 50 ms
}

TEST(Compensator, TimeThatRepeatsOrRunsBackwardsIsHeldAndReturns) {
  for (const double shift : {0.0, -0.002, -5.0, -1e9}) {
    auto compensator = world().compensator();
    for (Index k = 0; k < 200; ++k) compensator.step(test::sample_of(world().recording, k));
    OnlineSample sample = test::sample_of(world().recording, 199);
    sample.t += shift;
    EXPECT_EQ(compensator.step(sample).state, RunState::kHold) << shift;
    EXPECT_EQ(compensator.step(sample).reason, Reason::kClock) << shift;
    for (Index k = 200; k < 230; ++k) compensator.step(test::sample_of(world().recording, k));
    EXPECT_EQ(compensator.step(test::sample_of(world().recording, 230)).state, RunState::kNetwork);
  }
}

TEST(Compensator, AWildTimeStampIsFollowedByASteadyClockAgain) {
  auto compensator = world().compensator();
  for (Index k = 0; k < 200; ++k) compensator.step(world().samples[std::size_t(k)]);
  OnlineSample wild = world().samples[200];
  wild.t = 1e9;
  EXPECT_EQ(compensator.step(wild).reason, Reason::kGap);
  for (Index k = 201; k < 400; ++k) compensator.step(world().samples[std::size_t(k)]);
  EXPECT_EQ(compensator.step(world().samples[400]).state, RunState::kNetwork);
}

TEST(Compensator, FewMissingSamplesAreBridgedAndManyBeginAnew) {
  auto whole = world().compensator(), holed = world().compensator();
  for (Index k = 0; k < 600; ++k) {
    const OnlineSample sample = test::sample_of(world().recording, k);
    const Vector6d wanted = whole.step(sample).external;
    if (k > 200 && k % 20 < 4) continue;
    const auto& result = holed.step(sample);
    if (k < 300 || k % 20 < 6) continue;
    ASSERT_EQ(result.state, RunState::kNetwork) << k;
    ASSERT_LT((result.external - wanted).norm(), 0.2) << k;
  }
  const auto& after_gap = holed.step(test::sample_of(world().recording, 700));
  EXPECT_EQ(after_gap.state, RunState::kPhysics);
  EXPECT_EQ(after_gap.reason, Reason::kGap);
  RunState last = RunState::kPhysics;
  for (Index k = 701; k < 800; ++k) {
    last = holed.step(test::sample_of(world().recording, k)).state;
  }
  EXPECT_EQ(last, RunState::kNetwork);
}

TEST(Compensator, SilenceIsHeldFadedLatchedAndRearmedByTheOperatorAlone) {
  auto compensator = world().compensator();
  const GuardLimits limits;
  for (Index k = 0; k < 200; ++k) {
    compensator.step(test::sample_of(world().recording, k, {4, 0, 0}));
  }
  for (int k = 0; k < limits.hold_cycles; ++k) {
    EXPECT_EQ(compensator.miss().state, RunState::kHold);
  }
  for (int k = 0; k < limits.fade_cycles; ++k) {
    EXPECT_EQ(compensator.miss().state, RunState::kFade);
  }
  EXPECT_EQ(compensator.miss().state, RunState::kFault);
  EXPECT_EQ(compensator.miss().external.norm(), 0.0);
  OnlineSample sample = test::sample_of(world().recording, 201);
  EXPECT_EQ(compensator.step(sample).state, RunState::kFault);
  sample = test::sample_of(world().recording, 202);
  sample.rearm = true;
  EXPECT_EQ(compensator.step(sample).state, RunState::kWarmup);
  for (Index k = 203; k < 300; ++k) compensator.step(test::sample_of(world().recording, k));
  EXPECT_EQ(compensator.step(test::sample_of(world().recording, 300)).state, RunState::kNetwork);
}

TEST(Compensator, AnOverrunIsAnsweredByPhysics) {
  auto compensator = world().compensator();
  for (Index k = 0; k < 200; ++k) compensator.step(test::sample_of(world().recording, k));
  compensator.overrun();
  const auto& result = compensator.step(test::sample_of(world().recording, 200));
  EXPECT_EQ(result.state, RunState::kPhysics);
  EXPECT_EQ(result.reason, Reason::kOverrun);
}

TEST(Compensator, TheBiasIsTrackedInFreeMotionAndFrozenInContact) {
  CompensatorOptions options = test::mounted_options();
  options.bias_seconds = 1.0;
  options.contact_n = 1.0;
  auto compensator = world().compensator(options);
  const Vector3d offset(0.3, -0.2, 0.4);
  Vector3d before = Vector3d::Zero();
  for (Index k = 0; k < 6000; ++k) {
    const bool touching = k >= 5000;
    OnlineSample sample =
        test::sample_of(world().recording, k, touching ? Vector3d(0, 0, 4) : Vector3d::Zero());
    sample.wrench.head<3>() += offset;
    const auto& result = compensator.step(sample);
    if (k == 5030) before = result.bias;
    if (k == 4999) {
      EXPECT_LT((result.bias - offset).norm(), 0.1) << result.bias.transpose();
    }
    if (k > 5030) {
      ASSERT_EQ(result.bias, before) << k;
    }
  }
  options.contact_n.reset();
  EXPECT_THROW(OnlineCompensator(nullptr, &world().simulator, options, "test"), Error);
}

double any_number(Rng& rng) {
  constexpr std::array<double, 8> kBad{NAN, INFINITY, -INFINITY, 1e308, -1e308, 1e-310, 0.0, 1e9};
  const std::uint64_t bits = rng.bits();
  return bits % 2 == 0 ? kBad[(bits >> 8) % kBad.size()] : double(bits >> 32) * 2e-9 - 4.0;
}

TEST(Compensator, HostileSamplesNeverLeaveTheBounds) {
  OnlineCompensator compensator(nullptr, &world().simulator, test::mounted_options(), "test");
  const GuardLimits limits;
  Rng rng(9);
  Vector6d before = Vector6d::Zero();
  std::array<int, 6> seen{};
  Index broken = 0;
  for (Index k = 0; k < 300000; ++k) {
    OnlineSample sample = world().samples[static_cast<std::size_t>(k % 6000)];
    sample.t = 0.002 * static_cast<double>(k);
    const std::uint64_t what = rng.below(40);
    if (what < 6) sample.position[static_cast<Index>(what % 3)] = any_number(rng);
    if (what == 6) sample.t = any_number(rng);
    if (what == 7) (*sample.euler)[1] = any_number(rng);
    if (what > 36) sample.wrench[static_cast<Index>(rng.below(3))] = any_number(rng);
    if ((k / 3000) % 4 == 3) sample.wrench[0] = NAN;
    sample.rearm = k % 1000 == 0;
    const auto& result = compensator.step(sample);
    const Vector6d change = (result.external - before).cwiseAbs();
    broken += !result.external.allFinite() || !result.bias.allFinite() ||
              result.external.head<3>().cwiseAbs().maxCoeff() > limits.force_n ||
              change.head<3>().maxCoeff() > limits.slew_n * (1.0 + 1e-12);
    before = result.external;
    ++seen[static_cast<std::size_t>(result.state)];
  }
  EXPECT_EQ(broken, 0);
  for (const auto state : {RunState::kWarmup, RunState::kPhysics, RunState::kHold, RunState::kFade,
                           RunState::kFault}) {
    EXPECT_GT(seen[static_cast<std::size_t>(state)], 0) << name_of(state);
  }
}

Index resident_bytes() {
  Index pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * ::sysconf(_SC_PAGESIZE);
}

TEST(Compensator, AnHourOfCyclesNeedsNoMoreMemory) {
  auto compensator = world().compensator();
  constexpr Index kCycles = test::repetitions(1800000), kMiB = 1 << 20;
  Index before = 0;
  RunState state = RunState::kWarmup;
  for (Index k = 0; k < kCycles; ++k) {
    const Index place = k % 11998;  // forwards and backwards
    OnlineSample sample = world().samples[static_cast<std::size_t>(std::min(place, 11998 - place))];
    sample.t = 0.002 * static_cast<double>(k);
    state = compensator.step(sample).state;
    if (k == 100000) before = resident_bytes();
  }
  EXPECT_TRUE(state == RunState::kNetwork || state == RunState::kPhysics);
  // Less than a byte in a cycle: the smallest block of a heap has 32.
  EXPECT_LE(resident_bytes(), before + kCycles + kMiB);
}

TEST(Envelope, AnotherStretchOfTheSameMotionRaisesNoAlarm) {
  const Recording longer = test::free_motion(40000);  // the same sines, far beyond training
  const Eigen::MatrixXd x = make_features(longer, world().identifier.layout).x;
  const Envelope& envelope = world().identifier.online->envelope;
  Index alarms = 0;
  bool outside = false;
  for (Index k = 0; k < x.rows(); ++k) {
    const bool now = envelope.score(x.row(k).transpose()) > 1.0;
    alarms += now && !outside;
    outside = now;
  }
  EXPECT_LE(alarms, 1);
  const Envelope again = Envelope::parse(envelope.to_json(), "test");
  EXPECT_EQ(again.score(x.row(7).transpose()), envelope.score(x.row(7).transpose()));
}

TEST(Envelope, MotionThreeTimesAsFastIsSeen) {
  const Recording fast = test::free_motion(3000, 0.0, 3.0);
  const Eigen::MatrixXd x = make_features(fast, world().identifier.layout).x;
  Index seen = 0;
  for (Index k = 0; k < x.rows(); ++k) {
    seen += world().identifier.online->envelope.score(x.row(k).transpose()) > 1.0;
  }
  EXPECT_GT(seen, x.rows() / 4);
}

// Exponential scores: the level that the maximum of n of them exceeds with chance p is about
// log(n/p); independent scores, 10 a second, 100 s.
TEST(Envelope, TheAlarmLevelOfAKnownTailIsNearItsQuantile) {
  double mean = 0.0;
  constexpr int kDraws = 20;
  for (int draw = 0; draw < kDraws; ++draw) {
    Rng rng({7, static_cast<std::uint64_t>(draw)});
    Eigen::VectorXd scores(1000);
    for (double& score : scores) score = -std::log(1.0 - rng.uniform());
    mean += alarm_level(scores, 10.0, 1.0) / kDraws;
  }
  const double wanted = std::log(10.0 * 3600.0);
  EXPECT_GT(mean, wanted);  // errs towards silence
  EXPECT_LT(mean, 1.6 * wanted);
  // An hour and more of data: the order statistic itself.
  Eigen::VectorXd many(7200);
  for (Index k = 0; k < many.size(); ++k) many[k] = static_cast<double>(k);
  EXPECT_EQ(alarm_level(many, 1.0, 1.0), 7198.0);
}

}  // namespace
}  // namespace dcnn
