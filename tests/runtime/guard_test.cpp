// SPDX-License-Identifier: Apache-2.0
#include "dcnn/runtime/guard.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "dcnn/core/random.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

Cycle good(double force) {
  Cycle cycle;
  cycle.measured = Vector6d::Zero();
  cycle.measured.head<3>().setConstant(force);
  cycle.network = cycle.physics = Vector6d::Zero();
  return cycle;
}

Guard warm() {
  Guard guard;
  for (int k = 0; k < GuardLimits{}.warmup_cycles; ++k) guard.step(good(0.0));
  return guard;
}

double hostile(Rng& rng) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr std::array<double, 9> kBad{NAN, kInf, -kInf, 1e308, -1e308, 1e-310, 0.0, 1e38, -1e38};
  const std::uint64_t bits = rng.bits();
  return bits % 3 == 0 ? kBad[(bits >> 8) % kBad.size()] : double(bits >> 32) * 5e-8 - 100.0;
}

Cycle hostile_cycle(Rng& rng, int k) {
  const std::uint64_t bits = rng.bits();
  Cycle cycle;
  if (bits % 2 == 0) {
    cycle = good(hostile(rng));
  } else {
    const auto wrench = [&] {
      Vector6d w;
      for (double& value : w) value = hostile(rng);
      return w;
    };
    cycle.measured = wrench();
    if ((bits >> 4) % 8 != 0) cycle.network = wrench();
    if ((bits >> 8) % 8 != 0) cycle.physics = cycle.network.value_or(wrench());
    if ((bits >> 12) % 4 == 0) cycle.distrust = static_cast<Reason>((bits >> 16) % 14);
  }
  if ((k / 2000) % 3 == 1) cycle.measured[0] = NAN;  // long outages, too
  return cycle;
}

TEST(Guard, TenMillionHostileCyclesNeverLeaveItsBounds) {
  Rng rng(1);
  const GuardLimits limits;
  Guard guard;
  Vector6d before = Vector6d::Zero();
  std::array<int, 6> seen{};
  std::int64_t broken = 0;
  for (int k = 0; k < test::repetitions(10000000); ++k) {
    const Vector6d& output = guard.step(hostile_cycle(rng, k));
    const Vector6d size = output.cwiseAbs(), change = (output - before).cwiseAbs();
    broken += !output.allFinite() || size.head<3>().maxCoeff() > limits.force_n ||
              size.tail<3>().maxCoeff() > limits.torque_nm ||
              change.head<3>().maxCoeff() > limits.slew_n * (1.0 + 1e-12) ||
              change.tail<3>().maxCoeff() > limits.slew_nm * (1.0 + 1e-12);
    before = output;
    ++seen[static_cast<std::size_t>(guard.state())];
    if (guard.state() == RunState::kFault && k % 50 == 0) guard.rearm();
  }
  EXPECT_EQ(broken, 0);
  for (const int count : seen) EXPECT_GT(count, 0);
}

TEST(Guard, DistrustIsPhysicsInTheSameCycle) {
  for (const Reason reason : {Reason::kEnvelope, Reason::kOverrun, Reason::kGap}) {
    Guard guard = warm();
    guard.step(good(0.5));
    EXPECT_EQ(guard.state(), RunState::kNetwork);
    EXPECT_EQ(guard.reason(), Reason::kNone);
    Cycle outside = good(0.5);
    outside.distrust = reason;
    guard.step(outside);
    EXPECT_EQ(guard.state(), RunState::kPhysics);
    EXPECT_EQ(guard.reason(), reason);
    for (int k = 1; k < GuardLimits{}.return_cycles; ++k) {
      guard.step(good(0.5));
      EXPECT_EQ(guard.state(), RunState::kPhysics) << k;
      EXPECT_EQ(guard.reason(), Reason::kReturning) << k;
    }
    guard.step(good(0.5));
    EXPECT_EQ(guard.state(), RunState::kNetwork);
  }
}

TEST(Guard, AModelThatContradictsThePhysicsIsNotFollowed) {
  Guard guard = warm();
  Cycle cycle = good(0.0);
  (*cycle.network)[2] = 11.0;
  guard.step(cycle);
  EXPECT_EQ(guard.state(), RunState::kPhysics);
  EXPECT_EQ(guard.reason(), Reason::kDisagreement);
  cycle = good(0.0);
  (*cycle.network)[4] = 1.5;  // torque
  guard.step(cycle);
  EXPECT_EQ(guard.reason(), Reason::kDisagreement);
}

TEST(Guard, AModelThatWouldPushTheOutputBeyondItsLimitIsNotFollowed) {
  Guard guard = warm();
  Cycle cycle = good(48.0);
  (*cycle.network)[0] = -4.0;
  guard.step(cycle);
  EXPECT_EQ(guard.state(), RunState::kPhysics);
  EXPECT_EQ(guard.reason(), Reason::kLimit);
}

/// Bounds belong to what is allowed, and what is held back is said, on whichever axis.
TEST(Guard, StepsUpToTheBoundsArePassedAndWhatIsBeyondIsHeldBackAndSaid) {
  const GuardLimits limits;
  for (int axis = 0; axis < 6; ++axis) {
    const double slew = axis < 3 ? limits.slew_n : limits.slew_nm;
    const double limit = axis < 3 ? limits.force_n : limits.torque_nm;
    Guard guard = warm();
    Cycle cycle = good(0.0);
    cycle.measured[axis] = slew;
    EXPECT_EQ(guard.step(cycle)[axis], slew);
    EXPECT_FALSE(guard.limited()) << axis;
    cycle.measured[axis] = 2.5 * slew;
    EXPECT_EQ(guard.step(cycle)[axis], 2.0 * slew);
    EXPECT_TRUE(guard.limited()) << axis;
    EXPECT_EQ(guard.step(cycle)[axis], 2.5 * slew);
    EXPECT_FALSE(guard.limited()) << axis;
    cycle.measured[axis] = -1.5 * limit;
    for (int k = 0; k < 1000; ++k) guard.step(cycle);
    EXPECT_EQ(guard.step(cycle)[axis], -limit);
    EXPECT_TRUE(guard.limited()) << axis;
    EXPECT_EQ(guard.state(), RunState::kNetwork) << "both agree that it is beyond";
  }
}

TEST(Guard, ADisagreementUpToItsBoundIsFollowed) {
  const GuardLimits limits;
  for (int axis = 0; axis < 6; ++axis) {
    const double bound = axis < 3 ? limits.disagreement_n : limits.disagreement_nm;
    Guard guard = warm();
    Cycle cycle = good(0.0);
    (*cycle.network)[axis] = -bound;
    guard.step(cycle);
    EXPECT_EQ(guard.state(), RunState::kNetwork) << axis;
    (*cycle.network)[axis] = -bound * (1.0 + 1e-12);
    guard.step(cycle);
    EXPECT_EQ(guard.reason(), Reason::kDisagreement) << axis;
  }
}

TEST(Guard, AnOutageIsHeldFadedAndLatched) {
  const GuardLimits limits;
  Guard guard = warm();
  for (int k = 0; k < 5; ++k) guard.step(good(3.0));
  Cycle lost = good(3.0);
  lost.measured[1] = NAN;
  for (int k = 0; k < limits.hold_cycles; ++k) {
    EXPECT_EQ(guard.step(lost)[0], 3.0);
    EXPECT_EQ(guard.state(), RunState::kHold);
    EXPECT_EQ(guard.reason(), Reason::kNotFinite);
  }
  for (int k = 0; k < limits.fade_cycles; ++k) {
    guard.step(lost);
    EXPECT_EQ(guard.state(), RunState::kFade);
  }
  guard.step(lost);
  EXPECT_EQ(guard.state(), RunState::kFault);
  EXPECT_EQ(guard.step(good(3.0)).norm(), 0.0);
  EXPECT_EQ(guard.state(), RunState::kFault);
  EXPECT_EQ(guard.reason(), Reason::kLatched);
  guard.rearm();
  guard.step(good(3.0));
  EXPECT_EQ(guard.state(), RunState::kWarmup);
}

TEST(Guard, WarmupCountsOnlyCyclesThatCouldBeServed) {
  Guard guard;
  for (int k = 0; k < 1000; ++k) guard.step(Cycle{});
  EXPECT_EQ(guard.state(), RunState::kWarmup);
  for (int k = 0; k < GuardLimits{}.warmup_cycles; ++k) {
    guard.step(good(1.0));
    EXPECT_EQ(guard.state(), RunState::kWarmup);
  }
  guard.step(good(1.0));
  EXPECT_EQ(guard.state(), RunState::kNetwork);
}

TEST(Guard, AModelWithoutAnAnswerIsNotFollowedWithoutPhysicsEither) {
  for (const bool absent : {true, false}) {
    Guard guard = warm();
    Cycle cycle = good(0.0);
    cycle.physics.reset();
    guard.step(cycle);
    EXPECT_EQ(guard.state(), RunState::kNetwork);
    cycle.network->setConstant(NAN);
    if (absent) cycle.network.reset();
    EXPECT_EQ(guard.step(cycle).norm(), 0.0);
    EXPECT_EQ(guard.state(), RunState::kHold) << absent;
    EXPECT_EQ(guard.reason(), Reason::kModel) << absent;
  }
}

/// Model and physics are compared with each other and with the measurement, not with zero.
TEST(Guard, WhatIsComparedAreDifferences) {
  Guard guard = warm();
  Cycle cycle = good(40.0);
  cycle.network->setConstant(30.0);
  cycle.physics->setConstant(30.0);
  cycle.measured.tail<3>().setConstant(30.0);
  guard.step(cycle);
  EXPECT_EQ(guard.state(), RunState::kNetwork) << name_of(guard.reason());
  GuardLimits wide;
  wide.disagreement_n = 100.0;
  Guard other(wide);
  for (int k = 0; k < wide.warmup_cycles; ++k) other.step(good(0.0));
  cycle = good(48.0);
  (*cycle.network)[0] = -4.0;
  (*cycle.physics)[0] = 10.0;
  other.step(cycle);
  EXPECT_EQ(other.reason(), Reason::kLimit) << "the physics leaves 38 N";
}

TEST(Guard, EitherOfThemWarmsItUp) {
  for (const bool physics : {true, false}) {
    Guard guard;
    Cycle cycle = good(0.0);
    (physics ? cycle.network : cycle.physics).reset();
    for (int k = 0; k < GuardLimits{}.warmup_cycles; ++k) {
      guard.step(cycle);
      EXPECT_EQ(guard.state(), RunState::kWarmup) << k;
    }
    guard.step(cycle);
    EXPECT_EQ(guard.state(), physics ? RunState::kPhysics : RunState::kNetwork);
  }
}

TEST(Guard, OutagesThatEndedAreNotCountedAgain) {
  Guard guard = warm();
  Cycle lost = good(0.0);
  lost.measured[0] = NAN;
  for (int k = 0; k < 100; ++k) {
    for (int i = 0; i < GuardLimits{}.hold_cycles; ++i) {
      guard.step(lost);
      ASSERT_EQ(guard.state(), RunState::kHold) << k;
    }
    guard.step(good(0.0));
  }
}

TEST(Guard, PutsOutTheMeasuredLessThePredicted) {
  Guard guard = warm();
  Cycle cycle = good(0.75);
  cycle.network->setConstant(0.25);
  cycle.measured.tail<3>().setConstant(0.25);
  const Vector6d output = guard.step(cycle);
  EXPECT_EQ(output[0], 0.5);
  EXPECT_EQ(output[5], 0.0);
  cycle.distrust = Reason::kEnvelope;
  cycle.physics->setConstant(0.5);
  EXPECT_EQ(guard.step(cycle)[0], 0.25);
}

TEST(Guard, ARearmBeginsAnewAndOnlyAfterAFault) {
  Guard guard = warm();
  guard.rearm();
  guard.step(good(0.0));
  EXPECT_EQ(guard.state(), RunState::kNetwork) << "nothing was to be rearmed";
  Cycle lost;
  while (guard.state() != RunState::kFault) guard.step(lost);
  guard.rearm();
  EXPECT_EQ(guard.state(), RunState::kWarmup);
  EXPECT_EQ(guard.reason(), Reason::kWarmup);
}

/// 0.3 - (-0.1) is 0.4, and -0.1 + 0.4 is more than 0.3.
TEST(Guard, NoRoundingLeavesTheLimit) {
  GuardLimits limits;
  limits.force_n = 0.3;
  limits.slew_n = 10.0;
  Guard guard(limits);
  for (int k = 0; k < limits.warmup_cycles; ++k) guard.step(good(0.0));
  for (const double from : {-0.1, -0.2, 0.05, 0.1}) {
    guard.step(good(from));
    EXPECT_LE(guard.step(good(1.0))[0], limits.force_n) << from;
    guard.step(good(-from));
    EXPECT_GE(guard.step(good(-1.0))[0], -limits.force_n) << from;
  }
}

}  // namespace
}  // namespace dcnn
