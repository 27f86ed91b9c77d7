#include "dcnn/runtime/guard.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

Cycle good(double force) {
  return {Vector3d::Constant(force), Vector3d::Zero(), Vector3d::Zero(), true};
}

Guard warm() {
  Guard guard;
  for (int k = 0; k < GuardLimits{}.warmup_cycles; ++k) guard.step(good(0.0));
  return guard;
}

double hostile(Rng& rng) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr std::array<double, 9> kBad{NAN, kInf, -kInf, 1e308, -1e308, 1e-310, 0.0, 1e38, -1e38};
  return rng.below(3) == 0 ? kBad[rng.below(kBad.size())] : rng.uniform(-100.0, 100.0);
}

TEST(Guard, AMillionHostileCyclesNeverLeaveItsBounds) {
  Rng rng(1);
  const GuardLimits limits;
  Guard guard;
  Vector3d before = Vector3d::Zero();
  std::array<int, 6> seen{};
  for (int k = 0; k < 1000000; ++k) {
    const auto force = [&] { return Vector3d(hostile(rng), hostile(rng), hostile(rng)); };
    Cycle cycle{force(), {}, {}, rng.below(4) != 0};
    if (rng.below(8) != 0) cycle.network = force();
    if (rng.below(8) != 0) cycle.physics = Vector3d(cycle.network.value_or(force()));
    if (rng.below(2) != 0) cycle = good(rng.uniform(-100.0, 100.0));
    if ((k / 2000) % 3 == 1) cycle.measured[0] = NAN;  // long outages, too
    const Vector3d output = guard.step(cycle);
    ASSERT_TRUE(output.allFinite()) << k;
    ASSERT_LE(output.cwiseAbs().maxCoeff(), limits.force_n) << k;
    ASSERT_LE((output - before).cwiseAbs().maxCoeff(), limits.slew_n * (1.0 + 1e-12)) << k;
    before = output;
    ++seen[static_cast<std::size_t>(guard.state())];
    if (guard.state() == RunState::kFault && rng.below(50) == 0) guard.rearm();
  }
  for (const int count : seen) EXPECT_GT(count, 0);
}

TEST(Guard, AnInputOutsideTheEnvelopeIsPhysicsInTheSameCycle) {
  Guard guard = warm();
  guard.step(good(0.5));
  EXPECT_EQ(guard.state(), RunState::kNetwork);
  Cycle outside = good(0.5);
  outside.in_envelope = false;
  guard.step(outside);
  EXPECT_EQ(guard.state(), RunState::kPhysics);
  for (int k = 1; k < GuardLimits{}.return_cycles; ++k) {
    guard.step(good(0.5));
    EXPECT_EQ(guard.state(), RunState::kPhysics) << k;
  }
  guard.step(good(0.5));
  EXPECT_EQ(guard.state(), RunState::kNetwork);
}

TEST(Guard, AModelThatContradictsThePhysicsIsNotFollowed) {
  Guard guard = warm();
  Cycle cycle = good(0.0);
  cycle.network = Vector3d(0, 0, 11);
  guard.step(cycle);
  EXPECT_EQ(guard.state(), RunState::kPhysics);
}

TEST(Guard, AnOutageIsHeldFadedAndLatched) {
  const GuardLimits limits;
  Guard guard = warm();
  for (int k = 0; k < 5; ++k) guard.step(good(3.0));
  Cycle lost = good(3.0);
  lost.measured[1] = NAN;
  for (int k = 0; k < limits.hold_cycles; ++k) {
    EXPECT_EQ(guard.step(lost), Vector3d::Constant(3.0));
    EXPECT_EQ(guard.state(), RunState::kHold);
  }
  for (int k = 0; k < limits.fade_cycles; ++k) {
    guard.step(lost);
    EXPECT_EQ(guard.state(), RunState::kFade);
  }
  guard.step(lost);
  EXPECT_EQ(guard.state(), RunState::kFault);
  EXPECT_EQ(guard.step(good(3.0)), Vector3d::Zero());
  EXPECT_EQ(guard.state(), RunState::kFault);
  guard.rearm();
  guard.step(good(3.0));
  EXPECT_EQ(guard.state(), RunState::kWarmup);
}

}  // namespace
}  // namespace dcnn
