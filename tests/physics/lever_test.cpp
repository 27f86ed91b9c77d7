// SPDX-License-Identifier: Apache-2.0
// The torque of forces that act away from the sensor's origin.
#include <gtest/gtest.h>

#include "dcnn/physics/streaming_simulator.h"
#include "physics/support.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

const Vector3d kLever{0.05, -0.02, 0.2};

Json at_lever(Json parameters) {
  parameters["lever_x_m"] = kLever.x();
  parameters["lever_y_m"] = kLever.y();
  parameters["lever_z_m"] = kLever.z();
  return parameters;
}

TEST(Lever, AddsItsCrossProductWithTheForceThatTheEffectAdds) {
  const Motion motion = example_motion(500);
  Wrench carried = no_wrench(500);
  carried.force.col(0).setConstant(3.0);  // of others: no part of the torque
  for (const char* axis : {"base_y", "tool_z"}) {
    const auto effect = make_effect("viscous_friction", axis, at_lever({{"c_nspm", 2.0}}));
    const Wrench wrench = applied(effect, motion, carried);
    for (Index k = 0; k < 500; ++k) {
      const Vector3d added = (wrench.force.row(k) - carried.force.row(k)).transpose();
      EXPECT_LT((wrench.torque.row(k).transpose() - kLever.cross(added)).norm(), 1e-12) << axis;
    }
    EXPECT_GT(wrench.torque.norm(), 0.1);
  }
}

TEST(Lever, OutsideItsIntervalAForceMakesNoTorque) {
  const Motion motion = example_motion(500);
  const auto effect = make_effect("cable_spring", "alpha:sensor_x",
                                  at_lever({{"k_nprad", 2.0}, {"rest_rad", 0.1}}), {0.2, 0.4});
  const Wrench wrench = applied(effect, motion, no_wrench(500));
  EXPECT_EQ(wrench.torque.topRows(99).norm(), 0.0);
  EXPECT_GT(wrench.torque.middleRows(101, 90).norm(), 0.1);
}

TEST(Lever, IsNoParameterOfWhatIsNoForceAlongALine) {
  EXPECT_THROW(make_effect("mass", "", at_lever({{"delta_mass_kg", 0.1}})), Error);
  EXPECT_THROW(
      make_effect(
          "bias", "",
          at_lever({{"delta_bias_x_n", 1.0}, {"delta_bias_y_n", 0.0}, {"delta_bias_z_n", 0.0}})),
      Error);
}

TEST(Lever, StreamsAsItIsApplied) {
  Simulator simulator;
  simulator.model = example_tool();
  simulator.effects = {
      make_effect("coulomb_friction", "base_x", at_lever({{"fc_n", 0.7}, {"v0_mps", 0.01}}))};
  const Motion motion = example_motion(200, simulator.model);
  StreamingSimulator online(simulator, causal_derivative(), motion.dt, "test", Exit::kData);
  Simulator without = simulator;
  without.effects.clear();
  StreamingSimulator rigid(without, causal_derivative(), motion.dt, "test", Exit::kData);
  double most = 0.0;
  for (Index k = 0; k < 200; ++k) {
    const Vector3d position = motion.p_B.row(k), euler = motion.euler.row(k);
    const InstantWrench with = online.push(position, euler), alone = rigid.push(position, euler);
    const Vector3d added = with.force - alone.force;
    EXPECT_LT((with.torque - alone.torque - kLever.cross(added)).norm(), 1e-12);
    most = std::max(most, added.norm());
  }
  EXPECT_GT(most, 0.5);
}

}  // namespace
}  // namespace dcnn
