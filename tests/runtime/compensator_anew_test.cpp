// SPDX-License-Identifier: Apache-2.0
// What a compensator forgets, and when: after a gap, at the operator's word, and of the memory it
// is made in.
#include <gtest/gtest.h>

#include <cstring>
#include <new>

#include "runtime/steady.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

OnlineSample pressed_sample(Index k, double force) {
  OnlineSample sample = test::standing_sample(k);
  sample.wrench[0] = force;
  return sample;
}

/// Runs under a force, then into a fault for want of samples.
void fail(OnlineCompensator& compensator, Index samples) {
  for (Index k = 0; k < samples; ++k) compensator.step(pressed_sample(k, 4.0));
  for (int k = 0; k < 200; ++k) compensator.miss();
  ASSERT_EQ(compensator.miss().state, RunState::kFault);
}

void expect_same(const OnlineResult& got, const OnlineResult& wanted, Index k) {
  EXPECT_EQ(got.state, wanted.state) << k;
  EXPECT_EQ(got.reason, wanted.reason) << k << " " << name_of(got.reason);
  EXPECT_EQ(got.contact, wanted.contact) << k;
  EXPECT_EQ(got.external, wanted.external) << k;
  EXPECT_EQ(got.tool, wanted.tool) << k;
}

/// Readings, forces, clock and contact of the time before a fault count for nothing: after the
/// operator's word it answers as a new one does, on a clock that begins again.
TEST(CompensatorAnew, RearmedItIsAsNew) {
  const Identifier model = test::steady_identifier(Vector3d::Zero());
  CompensatorOptions options;
  options.average = 16;
  options.contact_n = 1.0;
  OnlineCompensator again(&model, nullptr, options, "test");
  OnlineCompensator fresh(&model, nullptr, options, "test");
  fail(again, 200);
  for (Index k = 0; k < 200; ++k) {
    OnlineSample sample = pressed_sample(k, k < 120 ? 0.3 : 2.0);
    const OnlineResult wanted = fresh.step(sample);
    sample.rearm = k == 0;
    expect_same(again.step(sample), wanted, k);
  }
}

/// Forces that its memory seems to hold from before are none: bytes of 7e read as 2e301 N.
TEST(CompensatorAnew, WhatItsMemoryHeldBeforeCountsForNothing) {
  const Identifier model = test::steady_identifier(Vector3d::Zero());
  CompensatorOptions options;
  options.contact_n = 1.0;
  alignas(OnlineCompensator) static unsigned char memory[sizeof(OnlineCompensator)];
  std::memset(memory, 0x7e, sizeof memory);
  asm volatile("" : : "r"(memory) : "memory");  // else the compiler leaves out the line before
  auto* used = new (memory) OnlineCompensator(&model, nullptr, options, "test");
  OnlineCompensator fresh(&model, nullptr, options, "test");
  for (Index k = 0; k < 200; ++k) {
    const OnlineSample sample = pressed_sample(k, k < 120 ? 0.3 : 2.0);
    const OnlineResult wanted = fresh.step(sample);
    if (k < 120 || k >= 145) {
      EXPECT_EQ(wanted.contact, k >= 145) << k;
    }
    expect_same(used->step(sample), wanted, k);
  }
  used->~OnlineCompensator();
}

TEST(CompensatorAnew, OnlyARisingEdgeRearms) {
  const Identifier model = test::steady_identifier(Vector3d::Zero());
  OnlineCompensator compensator(&model, nullptr, {}, "test");
  Index k = 0;
  const auto step = [&](bool rearm) {
    OnlineSample sample = test::standing_sample(k++);
    sample.rearm = rearm;
    return compensator.step(sample).state;
  };
  while (k < 100) step(true);
  for (int miss = 0; miss < 200; ++miss) compensator.miss();
  EXPECT_EQ(step(true), RunState::kFault) << "held since before the fault";
  EXPECT_EQ(step(true), RunState::kFault);
  EXPECT_EQ(step(false), RunState::kFault);
  EXPECT_EQ(step(true), RunState::kWarmup);
}

/// Without a fault there is nothing to rearm: nothing is forgotten.
TEST(CompensatorAnew, TheOperatorsWordChangesNothingInOperation) {
  const Identifier model = test::steady_identifier(Vector3d::Zero());
  CompensatorOptions options;
  options.average = 16;
  options.contact_n = 1.0;
  OnlineCompensator asked(&model, nullptr, options, "test");
  OnlineCompensator left(&model, nullptr, options, "test");
  for (Index k = 0; k < 300; ++k) {
    OnlineSample sample = pressed_sample(k, k < 150 ? 0.0 : 2.0);
    const OnlineResult wanted = left.step(sample);
    sample.rearm = k % 20 == 0;
    expect_same(asked.step(sample), wanted, k);
  }
}

/// The mean after a gap is that of the readings since.
TEST(CompensatorAnew, ReadingsBeforeAGapCountForNothing) {
  const Simulator simulator = test::tool_with_inertia(false);
  const Vector3d weight = test::weight_of(simulator);
  CompensatorOptions options;
  options.average = 16;
  options.guard.slew_n = 100.0;
  OnlineCompensator compensator(nullptr, &simulator, options, "test");
  for (Index k = 0; k < 100; ++k) {
    OnlineSample sample = test::standing_sample(k);
    sample.wrench.head<3>() = weight;
    compensator.step(sample);
  }
  for (Index k = 200; k < 230; ++k) {
    OnlineSample sample = test::standing_sample(k);
    sample.wrench.head<3>() = weight + Vector3d(3.0, 0.0, 0.0);
    const OnlineResult& result = compensator.step(sample);
    ASSERT_EQ(result.state, RunState::kPhysics) << k;
    EXPECT_NEAR(result.external[0], 3.0, 1e-9) << k;
  }
}

}  // namespace
}  // namespace dcnn
