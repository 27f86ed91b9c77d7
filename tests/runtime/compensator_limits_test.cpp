// SPDX-License-Identifier: Apache-2.0
// What a compensator may be made of, and what its options change: warm-up, torques, contact,
// limits.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "runtime/steady.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

using test::standing_sample;
using test::steady_identifier;
using test::tool_with_inertia;

void expect_unmade(const std::function<void()>& make, const std::string& words) {
  try {
    make();
    ADD_FAILURE() << "made, without: " << words;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

/// Cycles of warm-up of a simulator alone.
int warmup_of(const Simulator& simulator, const CompensatorOptions& options) {
  OnlineCompensator compensator(nullptr, &simulator, options, "test");
  int cycles = 0;
  while (cycles < 1000 &&
         compensator.step(standing_sample(cycles, compensator.dt())).state == RunState::kWarmup) {
    ++cycles;
  }
  return cycles;
}

TEST(CompensatorLimits, AnAverageIsOverOneToSixteenReadings) {
  const Simulator simulator = tool_with_inertia(false);
  CompensatorOptions options;
  for (const int average : {1, 16}) {
    options.average = average;
    EXPECT_NO_THROW(OnlineCompensator(nullptr, &simulator, options, "test")) << average;
  }
  for (const int average : {-1, 0, 17, 1000}) {
    options.average = average;
    expect_unmade([&] { OnlineCompensator(nullptr, &simulator, options, "test"); },
                  "the average must be over 1 to 16 readings");
  }
}

TEST(CompensatorLimits, NothingAndAModelThatLooksAheadAreRefused) {
  expect_unmade([] { OnlineCompensator(nullptr, nullptr, {}, "test"); },
                "neither a model nor a simulator");
  Identifier ahead = steady_identifier(Vector3d::Zero());
  ahead.layout.spec.derivative = DerivativeSpec();
  expect_unmade([&] { OnlineCompensator(&ahead, nullptr, {}, "test"); },
                "test: its derivatives are not causal");
}

/// The guard waits until the windows of the derivatives are full, and no less than it was told.
TEST(CompensatorLimits, TheWarmUpIsThatOfTheLongerWindow) {
  CompensatorOptions options;
  options.guard.warmup_cycles = 3;
  Simulator simulator = tool_with_inertia(false);
  const int full = static_cast<int>(causal_derivative().window(0.002));
  const int usual = warmup_of(simulator, options);
  EXPECT_EQ(usual, full);
  DerivativeSpec brief = causal_derivative();
  brief.window_s = 0.04;
  simulator.derivative = brief;
  EXPECT_EQ(warmup_of(simulator, options) - usual, static_cast<int>(brief.window(0.002)) - full);
  DerivativeSpec ahead;  // not for the loop: the usual one takes its place
  ahead.window_s = 0.04;
  simulator.derivative = ahead;
  EXPECT_EQ(warmup_of(simulator, options), usual);
  const Simulator slower = tool_with_inertia(false, 250.0);
  EXPECT_EQ(warmup_of(slower, options) - usual,
            static_cast<int>(causal_derivative().window(0.004)) - full);
  options.guard.warmup_cycles = 200;
  EXPECT_EQ(warmup_of(tool_with_inertia(false), options), 200);
}

TEST(CompensatorLimits, TimeAndDerivativesAreTheModels) {
  Identifier slow = steady_identifier(Vector3d::Zero());
  slow.layout.dt = 0.004;
  slow.layout.spec.derivative.window_s = 0.4;
  CompensatorOptions options;
  options.guard.warmup_cycles = 3;
  OnlineCompensator compensator(&slow, nullptr, options, "test");
  EXPECT_EQ(compensator.dt(), 0.004);
  const int full = static_cast<int>(slow.layout.spec.derivative.window(0.004));
  for (int k = 0; k < full; ++k) {
    ASSERT_EQ(compensator.step(standing_sample(k, 0.004)).state, RunState::kWarmup) << k;
  }
  EXPECT_EQ(compensator.step(standing_sample(full, 0.004)).state, RunState::kNetwork);
}

TEST(CompensatorLimits, TorquesArePredictedWhereAllThatPredictsDoes) {
  const Identifier force = steady_identifier(Vector3d::Zero());
  const Identifier wrench = steady_identifier(Eigen::VectorXd::Zero(6));
  const Simulator plain = tool_with_inertia(false), whole = tool_with_inertia(true);
  const auto torque = [](const Identifier* network, const Simulator* physics) {
    return OnlineCompensator(network, physics, {}, "test").has_torque();
  };
  EXPECT_FALSE(torque(nullptr, &plain));
  EXPECT_TRUE(torque(nullptr, &whole));
  EXPECT_FALSE(torque(&force, nullptr));
  EXPECT_TRUE(torque(&wrench, nullptr));
  EXPECT_FALSE(torque(&force, &plain));
  EXPECT_FALSE(torque(&force, &whole));
  EXPECT_TRUE(torque(&wrench, &whole));
  expect_unmade([&] { torque(&wrench, &plain); }, "give its tool an inertia");
}

TEST(CompensatorLimits, ItsGuardHasTheLimitsThatAreGiven) {
  const Identifier model = steady_identifier(Vector3d::Zero());
  CompensatorOptions options;
  options.guard.force_n = 2.0;
  OnlineCompensator compensator(&model, nullptr, options, "test");
  for (Index k = 0; k < 200; ++k) {
    OnlineSample sample = standing_sample(k);
    sample.wrench[0] = 30.0;
    const auto& result = compensator.step(sample);
    ASSERT_LE(result.external.cwiseAbs().maxCoeff(), 2.0) << k;
  }
}

/// A force is contact by its mean over 50 ms, 25 samples, above the threshold, until it is below
/// half of it.
TEST(CompensatorLimits, ContactIsAForceThatLasts) {
  const Identifier model = steady_identifier(Vector3d::Zero());
  for (const double threshold : {1.0, 3.0}) {
    CompensatorOptions options;
    options.contact_n = threshold;
    OnlineCompensator compensator(&model, nullptr, options, "test");
    Index k = 0;
    const auto press = [&](double force) {
      OnlineSample sample = standing_sample(k++);
      sample.wrench[0] = force;
      return compensator.step(sample).contact;
    };
    while (k < 100) ASSERT_FALSE(press(0.0));
    EXPECT_FALSE(press(20.0 * threshold)) << "a blow of one sample";
    while (k < 200) ASSERT_FALSE(press(0.0));
    for (int held = 1; held <= 25; ++held) EXPECT_EQ(press(2.0 * threshold), held > 12) << held;
    for (int free = 1; free <= 25; ++free) EXPECT_EQ(press(0.0), free <= 18) << free;
  }
}

TEST(CompensatorLimits, TheFallbackSeesContactTooOnceItIsWarm) {
  const Simulator simulator = tool_with_inertia(false);
  const Vector3d weight = test::weight_of(simulator);
  CompensatorOptions options;
  options.contact_n = 1.0;
  OnlineCompensator compensator(nullptr, &simulator, options, "test");
  for (Index k = 0; k < 300; ++k) {
    OnlineSample sample = standing_sample(k);
    sample.wrench.head<3>() = weight + Vector3d(k < 20 || k >= 200 ? 2.0 : 0.0, 0.0, 0.0);
    EXPECT_EQ(compensator.step(sample).contact, k >= 212) << k;
  }
}

/// A limit that holds the output back is told.
TEST(CompensatorLimits, AnOutputThatIsHeldBackIsMarked) {
  const Identifier model = steady_identifier(Vector3d::Zero());
  CompensatorOptions options;
  options.guard.slew_n = 0.5;
  OnlineCompensator compensator(&model, nullptr, options, "test");
  for (Index k = 0; k < 200; ++k) {
    OnlineSample sample = standing_sample(k);
    sample.wrench[0] = k < 100 ? 0.0 : 2.0;
    const OnlineResult& result = compensator.step(sample);
    EXPECT_EQ(result.limited, k >= 100 && k < 103) << k;
  }
  EXPECT_EQ(compensator.miss().reason, Reason::kMissing);
}

/// Without a time constant no bias is tracked, though contact is detected.
TEST(CompensatorLimits, NoBiasIsTrackedUnasked) {
  const Identifier model = steady_identifier(Vector3d::Zero());
  CompensatorOptions options;
  options.contact_n = 1.0;
  OnlineCompensator compensator(&model, nullptr, options, "test");
  for (Index k = 0; k < 600; ++k) {
    OnlineSample sample = standing_sample(k);
    sample.wrench[1] = 0.4;
    ASSERT_EQ(compensator.step(sample).bias, Vector3d::Zero()) << k;
  }
}

/// The newest of n readings has the weight n, the oldest 1 (D30).
TEST(CompensatorLimits, TheAverageIsWeightedByAge) {
  const Identifier model = steady_identifier(Vector3d::Zero());
  for (const int average : {1, 2, 5, 16}) {
    CompensatorOptions options;
    options.average = average;
    OnlineCompensator compensator(&model, nullptr, options, "test");
    Index k = 0;
    const auto pushed = [&](double force) {
      OnlineSample sample = standing_sample(k++);
      sample.wrench[0] = force;
      return compensator.step(sample).external[0];
    };
    while (k < 200) pushed(0.6);
    EXPECT_NEAR(pushed(0.6), 0.6, 1e-12);
    double held = 0.0;  // weight of the readings since the step
    const double all = 0.5 * average * (average + 1);
    for (int age = 0; age < 20; ++age) {
      held += std::max(average - age, 0);
      EXPECT_NEAR(pushed(1.2), 0.6 + 0.6 * held / all, 1e-12) << average << " " << age;
    }
  }
}

/// A standing robot's samples at times of our choice, and what is said of each.
class CompensatorClock : public testing::Test {
 protected:
  CompensatorClock() {
    for (Index k = 0; k < 100; ++k) at(0.002 * static_cast<double>(k));
  }
  const OnlineResult& at(double t) {
    OnlineSample sample;
    sample.t = t;
    return compensator_.step(sample);
  }
  bool refuses(double t) { return at(t).reason == Reason::kClock; }
  static constexpr double kLast = 0.002 * 99;

 private:
  const Identifier model_ = steady_identifier(Vector3d::Zero());
  OnlineCompensator compensator_{&model_, nullptr, {}, "test"};
};

TEST_F(CompensatorClock, ASampleCountsFromSixTenthsOfItsTime) {
  EXPECT_TRUE(refuses(kLast + 0.59 * 0.002));
  EXPECT_FALSE(refuses(kLast + 0.61 * 0.002));
}

TEST_F(CompensatorClock, AnotherClockIsFollowedAfter25SteadySamples) {
  // The first sample of the other clock is a jump, then 25 that are steady.
  for (int k = 0; k < 25; ++k) ASSERT_TRUE(refuses(-1.0 + 0.002 * k)) << k;
  EXPECT_EQ(at(-1.0 + 0.002 * 25).reason, Reason::kGap);  // windows begin anew
  EXPECT_FALSE(refuses(-1.0 + 0.002 * 26));
}

/// Two senders in turn: each sample of the clock that is followed ends the row of the other.
TEST_F(CompensatorClock, AClockBesideTheFollowedOneIsNeverFollowed) {
  for (int k = 0; k < 60; ++k) {
    ASSERT_TRUE(refuses(-1.0 + 0.002 * k)) << k;
    ASSERT_FALSE(refuses(kLast + 0.002 * (k + 1))) << k;
  }
}

TEST_F(CompensatorClock, AnUnsteadyClockIsNeverFollowed) {
  for (const double step : {0.55, 1.45}) {
    for (int k = 0; k < 40; ++k) ASSERT_TRUE(refuses(-1.0 + step * 0.002 * k)) << step << " " << k;
  }
}

TEST_F(CompensatorClock, SteadySamplesCountInARow) {
  for (int k = 0; k < 80; ++k) ASSERT_TRUE(refuses(-2.0 + 0.002 * (k + 5 * (k / 20)))) << k;
}

TEST_F(CompensatorClock, FourMissingSamplesAreBridgedAndFiveAreAGap) {
  EXPECT_NE(at(kLast + 5.4 * 0.002).reason, Reason::kGap);
  EXPECT_EQ(at(kLast + (5.4 + 5.6) * 0.002).reason, Reason::kGap);
}

/// A wrist that turns while samples are missing: what is between is on the way, whichever sign its
/// quaternion has, whether it comes as angles, and where angles begin or end, outside or in
/// between.
TEST(CompensatorLimits, MissingSamplesLieOnTheWay) {
  const Simulator simulator = tool_with_inertia(true);
  const auto turned = [](Index k, int kind) {
    OnlineSample sample = standing_sample(k);
    const double angle = 3.0 + 0.004 * static_cast<double>(k);  // passes pi
    sample.position = Vector3d(0.1, -0.2, 0.3) * 0.002 * static_cast<double>(k);
    sample.quaternion = {std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle)};
    if (kind == 1 && k % 2 == 1) sample.quaternion = -sample.quaternion;
    const bool changes_within = kind == 4 && (k % 14 < 4 || k % 14 > 10);
    if (kind == 2 || (kind == 3 && k % 14 < 7) || changes_within) {
      sample.euler = Vector3d(std::remainder(angle, 6.283185307179586), 0.0, 0.0);
    }
    if (kind == 2 || changes_within) sample.quaternion = {1.0, 0.0, 0.0, 0.0};  // does not count
    return sample;
  };
  for (const auto& [kind, missing] : {std::pair(0, 3), {1, 3}, {2, 3}, {3, 3}, {4, 3}, {0, 1}}) {
    OnlineCompensator whole(nullptr, &simulator, {}, "test");
    OnlineCompensator holed(nullptr, &simulator, {}, "test");
    for (Index k = 0; k < 300; ++k) {
      const Vector6d wanted = whole.step(turned(k, kind)).tool;
      if (k > 10 && k % 7 >= 3 && k % 7 < 3 + missing) continue;
      const Vector6d got = holed.step(turned(k, kind)).tool;
      if (k <= 60) continue;
      ASSERT_LT((got - wanted).norm(), 1e-3) << kind << " " << k;
    }
  }
}

/// A first-order filter with the time constant that is given, after half a second without contact.
TEST(CompensatorLimits, TheBiasIsFollowedAtItsRateAfterAQuietHalfSecond) {
  const Identifier model = steady_identifier(Vector3d::Zero());
  CompensatorOptions options;
  options.bias_seconds = 2.0;
  options.contact_n = 1.0;
  OnlineCompensator compensator(&model, nullptr, options, "test");
  int quiet = 0, steps = 0;
  for (Index k = 0; k < 1500; ++k) {
    OnlineSample sample = standing_sample(k);
    sample.wrench[1] = 0.4;
    const auto& result = compensator.step(sample);
    quiet += result.state == RunState::kNetwork;
    if (quiet >= 250) ++steps;  // 0.5 s
    ASSERT_NEAR(result.bias[1], 0.4 * (1.0 - std::pow(0.999, steps)), 1e-12) << k;
  }
  EXPECT_GT(steps, 1000);
}

/// The answer names the prediction that it follows: an overrun is answered by the fallback, once.
TEST(CompensatorLimits, TheToolIsThatOfWhoIsFollowed) {
  const Identifier model = steady_identifier(Vector3d(0.1, 0.2, 0.3));
  const Simulator simulator = tool_with_inertia(false);
  OnlineCompensator both(&model, &simulator, {}, "test");
  Index k = 0;
  while (k < 200) both.step(standing_sample(k++));
  EXPECT_EQ(both.step(standing_sample(k++)).tool.head<3>(), Vector3d(0.1, 0.2, 0.3));
  both.overrun();
  const OnlineResult& late = both.step(standing_sample(k++));
  EXPECT_EQ(late.reason, Reason::kOverrun);
  EXPECT_NEAR(late.tool.head<3>().norm(), 0.75 * 9.81, 0.05);
  const auto last = k + 100;
  while (k < last) both.step(standing_sample(k++));
  EXPECT_EQ(both.step(standing_sample(k++)).state, RunState::kNetwork);
}

/// Without a prediction of torques none is given.
TEST(CompensatorLimits, TorquesAreZeroWhereNonePredictsThem) {
  for (const Index targets : {3, 6}) {
    const Identifier model = steady_identifier(Eigen::VectorXd::Zero(targets));
    OnlineCompensator compensator(&model, nullptr, {}, "test");
    double torque = 0.0;
    for (Index k = 0; k < 200; ++k) {
      OnlineSample sample = standing_sample(k);
      sample.wrench[4] = 0.5;
      torque = compensator.step(sample).external[4];
    }
    EXPECT_NEAR(torque, targets == 6 ? 0.5 : 0.0, 1e-12);
  }
}

TEST(CompensatorLimits, OnlyAnglesAsFeaturesAreSingular) {
  for (const auto set : {FeatureSpec::Set::kPose, FeatureSpec::Set::kBody}) {
    const Identifier model = steady_identifier(Vector3d::Zero(), set);
    OnlineCompensator compensator(&model, nullptr, {}, "test");
    bool singular = false;
    for (Index k = 0; k < 400; ++k) {
      OnlineSample sample = standing_sample(k);
      sample.euler = Vector3d(0.0, k < 200 ? 0.0 : 1.5707963, 0.0);
      singular = compensator.step(sample).reason == Reason::kSingular || singular;
      ASSERT_TRUE(!singular || k >= 200) << k;
    }
    EXPECT_EQ(singular, set == FeatureSpec::Set::kPose);
  }
}

}  // namespace
}  // namespace dcnn
