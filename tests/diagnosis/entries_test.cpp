// SPDX-License-Identifier: Apache-2.0
// Effects of several numbers of which the recordings tell some alone, and the simulator's own
// numbers before faults of the sensor that change the same forces.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/support.h"

namespace dcnn {
namespace {

using test::Bench;
using test::hidden;

/// Poses at rest of a wrist sensor with force and torque.
Json at_rest(const Json& hidden, int poses) {
  Json world = test::configuration(hidden);
  world["simulator"]["tool"]["inertia_kgm2"] = {0.004, 0.004, 0.001, 0.0, 0.0, 0.0};
  world["force_noise"]["nm"] = 0.002;
  world["recordings"] = {
      {{"name", "fit"},
       {"samples", poses},
       {"trajectory",
        {{"kind", "static"}, {"angle_rad", {3.0, 1.4, 3.0}}, {"angle_center_rad", {0, 0, 0}}}}}};
  return world;
}

Json finding(const Json& report, const std::string& effect) {
  for (const Json& f : report["findings"]) {
    if (f["effect"] == effect) return f;
  }
  return nullptr;
}

double value(const Json& report, const std::string& effect, const char* number) {
  return finding(report, effect)["parameters"][number]["value"].get<double>();
}

// A sensor whose z axis reads 6 % too much, of a tool that is 40 % heavier: a gain of 40, 40 and 48
// % with another centre of mass makes the same forces, and needs one number more.
TEST(Entries, OfAGainBesideAMassAreOne) {
  const Json report =
      Bench(at_rest({hidden("mass", nullptr, {{"delta_mass_kg", 0.3}}),
                     hidden("gain", nullptr, {{"gain_x", 0.0}, {"gain_y", 0.0}, {"gain_z", 0.06}})},
                    40))
          .diagnose(false)
          .report;
  EXPECT_EQ(test::found(report), (std::set<std::string>{"gain", "mass"}))
      << report["findings"].dump(1);
  EXPECT_NEAR(value(report, "mass", "delta_mass_kg"), 0.3, 0.01);
  EXPECT_NEAR(value(report, "gain", "gain_z"), 0.06, 0.01);
  for (const char* none : {"gain_x", "gain_y"}) {
    const Json number = finding(report, "gain")["parameters"][none];
    EXPECT_EQ(number["value"], 0.0);
    // Zero is what is left of the number, not all that it may be.
    EXPECT_LT(number["ci95"][0].get<double>(), 0.0);
    EXPECT_GT(number["ci95"][1].get<double>(), 0.0);
  }
}

TEST(Entries, OfCrosstalkAreThoseThatAct) {
  const Json report = Bench(test::configuration(Json::array({hidden("crosstalk", nullptr,
                                                                    {{"c_xy", 0.0},
                                                                     {"c_xz", 0.03},
                                                                     {"c_yx", 0.0},
                                                                     {"c_yz", 0.0},
                                                                     {"c_zx", 0.0},
                                                                     {"c_zy", 0.0}})})))
                          .diagnose()
                          .report;
  ASSERT_EQ(test::names(report), std::vector<std::string>{"crosstalk"})
      << report["findings"].dump(1);
  EXPECT_NEAR(value(report, "crosstalk", "c_xz"), 0.03, 0.002);
  int entries = 0;
  for (const auto& [name, number] : report["findings"][0]["parameters"].items()) {
    entries += number["value"].get<double>() != 0.0;
    EXPECT_LT(std::abs(number["ci95"][0].get<double>()), 0.05) << name;
  }
  EXPECT_EQ(entries, 1) << report["findings"].dump(1);
}

// The base of a robot on a wall: its floor is what a free matrix on the gravity that the poses show
// leaves, else all that the centre of mass makes there is noise.
TEST(Entries, OfARobotOnAWallAreItsTiltMassAndCentre) {
  const Json report =
      Bench(
          at_rest(
              {hidden("gravity_tilt", nullptr, {{"tilt_x_rad", 0.0}, {"tilt_y_rad", -1.4}}),
               hidden("mass", nullptr, {{"delta_mass_kg", 0.3}}),
               hidden("com", nullptr,
                      {{"delta_com_x_m", 0.02}, {"delta_com_y_m", 0.0}, {"delta_com_z_m", 0.01}})},
              17))
          .diagnose(false)
          .report;
  EXPECT_EQ(test::found(report), (std::set<std::string>{"com", "gravity_tilt", "mass"}))
      << report["findings"].dump(1);
  EXPECT_LT(report["fit"]["noise_floor"][3].get<double>(), 0.004);
}

// Few poses of a tool of which every number is wrong: no single effect explains much before the
// others do, and a mass that is 40 % larger is likelier than a sensor that reads 40 % too much.
TEST(Entries, OfAToolOfWhichEveryNumberIsWrongAreAllFound) {
  for (const int seed : {3, 4, 14}) {
    Json world = at_rest(
        {hidden("mass", nullptr, {{"delta_mass_kg", 0.08}}),
         hidden("com", nullptr,
                {{"delta_com_x_m", 0.026}, {"delta_com_y_m", 0.0}, {"delta_com_z_m", 0.004}}),
         hidden("gravity_tilt", nullptr, {{"tilt_x_rad", 0.0}, {"tilt_y_rad", 0.17}}),
         hidden("bias", nullptr,
                {{"delta_bias_x_n", 0.4},
                 {"delta_bias_y_n", -3.1},
                 {"delta_bias_z_n", 5.5},
                 {"delta_bias_tx_nm", -0.07},
                 {"delta_bias_ty_nm", -0.02},
                 {"delta_bias_tz_nm", -0.05}})},
        seed > 10 ? 20 : 11);
    world["seed"] = seed;
    world["simulator"]["tool"] = {{"mass_kg", 0.2}, {"com_m", {0.0, 0.0, 0.02}}};
    world["simulator"]["tool"]["inertia_kgm2"] = {4e-4, 4e-4, 1e-4, 0.0, 0.0, 0.0};
    world["pose_noise"]["rad"] = 5e-4;
    world["force_noise"] = {{"n", 0.035}, {"nm", 0.001}};
    const Json report = Bench(world).diagnose(false).report;
    EXPECT_EQ(test::found(report), (std::set<std::string>{"bias", "com", "gravity_tilt", "mass"}))
        << report["findings"].dump(1);
    EXPECT_GT(finding(report, "mass")["confidence"].get<double>(), 0.6) << seed;
  }
}

// Held-out torques without the offset that those of the fit have.
TEST(Entries, ThatHeldOutChannelsSpeakAgainstAreNotSure) {
  Json world = test::configuration(Json::array({hidden("bias", nullptr,
                                                       {{"delta_bias_x_n", 1.0},
                                                        {"delta_bias_y_n", -2.0},
                                                        {"delta_bias_z_n", 3.0},
                                                        {"delta_bias_tx_nm", 0.2},
                                                        {"delta_bias_ty_nm", 0.0},
                                                        {"delta_bias_tz_nm", 0.0}})}));
  world["simulator"]["tool"]["inertia_kgm2"] = {0.004, 0.004, 0.001, 0.0, 0.0, 0.0};
  world["force_noise"]["nm"] = 0.005;
  const Bench bench(world);
  Recording log = read_recording(bench / "hold.csv", ReadOptions(), System());
  log.set("tx", log.column("tx").array() - 0.2);
  write_csv(bench / "hold.csv", log.table);
  const Json report = bench.diagnose().report;
  const Json bias = finding(report, "bias");
  ASSERT_FALSE(bias.is_null()) << report["findings"].dump(1);
  EXPECT_EQ(bias["against"], Json::array({"tx"}));
  EXPECT_LT(bias["confidence"].get<double>(), 0.5);
}

// No alternative is listed that evidence and held-out data exclude.
TEST(Entries, HaveNoAlternativesThatAreExcluded) {
  const Json report =
      Bench(at_rest({hidden("mass", nullptr, {{"delta_mass_kg", 0.08}}),
                     hidden("misalignment", nullptr,
                            {{"rot_x_rad", 0.0}, {"rot_y_rad", 0.03}, {"rot_z_rad", 0.0}})},
                    24))
          .diagnose(false)
          .report;
  for (const Json& f : report["findings"]) {
    const Json shared = f.value("shared_with", Json::object());
    for (const auto& [name, share] : shared.items()) {
      EXPECT_GT(share.get<double>(), 1e-3) << name << " in place of " << f["effect"];
    }
  }
}

}  // namespace
}  // namespace dcnn
