// SPDX-License-Identifier: Apache-2.0
// Recordings with torques: where on the tool a force acts.
#include <gtest/gtest.h>

#include "diagnosis/support.h"

namespace dcnn {
namespace {

using test::Bench;
using test::hidden;

const double kLever[3] = {0.03, -0.02, 0.15};

Json with_torque(const Json& effects) {
  Json config = test::configuration(effects);
  config["simulator"]["tool"]["inertia_kgm2"] = {0.021, 0.02, 0.002, 0.0, 0.0, 0.0};
  config["force_noise"]["nm"] = 0.003;
  return config;
}

Json at_lever(Json parameters) {
  for (int i = 0; i < 3; ++i) {
    parameters[std::string("lever_") + "xyz"[i] + "_m"] = kLever[i];
  }
  return parameters;
}

/// Within four deviations, which are known to a centimetre.
void expect_lever(const Json& parameters, const std::string& axes) {
  for (int i = 0; i < 3; ++i) {
    if (axes.find("xyz"[i]) == std::string::npos) continue;
    const Json& told = parameters[std::string("lever_") + "xyz"[i] + "_m"];
    const double half = 0.5 * (told["ci95"][1].get<double>() - told["ci95"][0].get<double>());
    EXPECT_NEAR(told["value"].get<double>(), kLever[i], 2.0 * half) << i;
    EXPECT_LT(half, 0.01) << i;
  }
}

TEST(Wrench, FrictionAndACableAreFoundWhereTheyAct) {
  const Bench bench(with_torque(
      {hidden("coulomb_friction", "base_y", at_lever({{"fc_n", 0.4}, {"v0_mps", 0.01}})),
       hidden("cable_spring", "gamma:sensor_x", at_lever({{"k_nprad", 0.4}, {"rest_rad", 3.0}}))}));
  const Json report = bench.diagnose().report;
  EXPECT_EQ(report["verdict"], "explained");
  ASSERT_EQ(test::found(report), (std::set<std::string>{"coulomb_friction", "cable_spring"}));
  for (const Json& finding : report["findings"]) {
    const bool cable = finding["effect"] == "cable_spring";
    // Along its own axis a lever makes no torque.
    expect_lever(finding["parameters"], cable ? "yz" : "xyz");
    EXPECT_NE(finding["words"].get<std::string>().find("from the sensor's origin"),
              std::string::npos);
  }
}

/// The steps of the forces, of 50 mN, are none of the torques, whose noise is 3 mN m.
TEST(Wrench, ACoarseForceHidesNoTorque) {
  const Bench bench(with_torque(
      {hidden("coulomb_friction", "base_y", at_lever({{"fc_n", 0.4}, {"v0_mps", 0.01}})),
       hidden("quantisation", nullptr, {{"step_n", 0.05}})}));
  const Json report = bench.diagnose().report;
  EXPECT_EQ(report["verdict"], "explained");
  EXPECT_EQ(test::found(report), (std::set<std::string>{"coulomb_friction", "quantisation"}))
      << report["findings"].dump(1);
  for (std::size_t j = 3; j < 6; ++j) {
    EXPECT_NEAR(report["fit"]["noise_floor"][j].get<double>(), 0.003, 0.0003) << j;
  }
}

TEST(Wrench, ALawWithoutANameActsSomewhereToo) {
  Json law = hidden("discovered", nullptr,
                    at_lever({{"amplitude_n", -2.0}, {"scale_1_mps", 0.1}, {"power_1", 1.5}}));
  law["law"] = {{"axis", "tool_z"}, {"factors", {{{"shape", "power"}, {"of", "v_tool_z"}}}}};
  const Bench bench(with_torque(Json::array({law})));
  const Json report = bench.diagnose().report;
  EXPECT_TRUE(test::names(report).empty()) << report["findings"].dump(1);
  ASSERT_FALSE(report["findings"].empty());
  expect_lever(report["findings"][0]["parameters"], "xy");
  for (std::size_t j = 0; j < 6; ++j) {
    EXPECT_LT(report["fit"]["holdout_rmse_after"][j].get<double>(),
              1.1 * report["fit"]["holdout_noise_floor"][j].get<double>())
        << j;
  }
}

TEST(Wrench, AForceThroughTheOriginHasNoLever) {
  const Bench bench(with_torque(
      Json::array({hidden("coulomb_friction", "base_y", {{"fc_n", 0.4}, {"v0_mps", 0.01}})})));
  const Json report = bench.diagnose().report;
  ASSERT_EQ(test::names(report), std::vector<std::string>{"coulomb_friction"});
  EXPECT_FALSE(report["findings"][0]["parameters"].contains("lever_x_m"));
}

/// An instrument of 60 g, 0.2 m below the sensor, that the simulator has not: the mass, its centre
/// and the inertia, m (r^2 E - r r^T), in which the last entries are zero.
TEST(Wrench, AnotherInertiaIsNamedByTheTorques) {
  const double before = 0.75, added = 0.06, r = 0.2;
  const Eigen::Vector3d centre(0.004, -0.006, 0.16), place(0.0, 0.0, r);
  const Eigen::Vector3d moved = (added * (place - centre)) / (before + added);
  const Bench bench(with_torque(
      {hidden("mass", nullptr, {{"delta_mass_kg", added}}),
       hidden(
           "com", nullptr,
           {{"delta_com_x_m", moved(0)}, {"delta_com_y_m", moved(1)}, {"delta_com_z_m", moved(2)}}),
       hidden("inertia_tensor", nullptr,
              {{"delta_inertia_xx_kgm2", added * r * r},
               {"delta_inertia_yy_kgm2", added * r * r},
               {"delta_inertia_zz_kgm2", 0.0},
               {"delta_inertia_xy_kgm2", 0.0},
               {"delta_inertia_xz_kgm2", 0.0},
               {"delta_inertia_yz_kgm2", 0.0}})}));
  const Json report = bench.diagnose().report;
  EXPECT_EQ(report["verdict"], "explained");
  ASSERT_EQ(test::found(report), (std::set<std::string>{"mass", "com", "inertia_tensor"}))
      << report["findings"].dump(1);
  for (const Json& finding : report["findings"]) {
    if (finding["effect"] != "inertia_tensor") continue;
    const Json& yy = finding["parameters"]["delta_inertia_yy_kgm2"];
    EXPECT_EQ(yy["unit"], "kg*m^2");
    EXPECT_NEAR(yy["value"].get<double>(), added * r * r, 1e-4);
  }
}

TEST(Wrench, NothingIsMissingWhereNothingIs) {
  EXPECT_EQ(Bench(with_torque(Json::array())).diagnose().report["verdict"], "consistent");
}

}  // namespace
}  // namespace dcnn
