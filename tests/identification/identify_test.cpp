// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "dcnn/core/random.h"
#include "dcnn/data/rotation.h"
#include "dcnn/physics/simulator.h"
#include "identification/support.h"

namespace dcnn {
namespace {

using identification_tests::identified;
using identification_tests::number;
using identification_tests::Setting;
using identification_tests::simulated;
using testing::contains;

/// Half an interval is 1.96 deviations: four of them are beyond chance for all numbers of a test.
void expect_near(const IdentifiedNumber& e, double truth) {
  const double half = 0.5 * (e.high - e.low);
  EXPECT_LT(std::abs(e.value - truth), 2.1 * half) << e.name;
  EXPECT_LT(e.low, e.value) << e.name;
  EXPECT_LT(e.value, e.high) << e.name;
}

TEST(Identify, AMovingLogWithTorqueGivesTheToolItsMountingAndItsOffset) {
  const ToolIdentification id = identified({});
  EXPECT_NEAR(number(id, "mass_kg").value, 0.75, 0.0075);
  EXPECT_NEAR(number(id, "com_x_m").value, 0.004, 0.001);
  EXPECT_NEAR(number(id, "com_y_m").value, -0.006, 0.001);
  EXPECT_NEAR(number(id, "com_z_m").value, 0.16, 0.001);
  const std::pair<const char*, double> truth[] = {
      {"mass_kg", 0.75},           {"com_x_m", 0.004},           {"com_y_m", -0.006},
      {"com_z_m", 0.16},           {"inertia_xx_kgm2", 0.0215},  {"inertia_yy_kgm2", 0.0213},
      {"inertia_zz_kgm2", 9e-4},   {"inertia_yz_kgm2", 8e-4},    {"mounting_rx_rad", -0.0262},
      {"mounting_ry_rad", 0.0349}, {"mounting_rz_rad", -0.5236}, {"bias_x_n", 0.6},
      {"bias_z_n", 1.1},           {"bias_ty_nm", -0.01}};
  for (const auto& [name, value] : truth) expect_near(number(id, name), value);
  EXPECT_TRUE(id.beside.empty()) << to_text(id);
  EXPECT_LT(number(id, "mass_kg").high - number(id, "mass_kg").low, 0.01);
  ASSERT_TRUE(id.model.inertia.has_value());
}

TEST(Identify, FromForcesAloneTheCentreComesFromTheTurning) {
  Setting setting;
  setting.simulator = identification_tests::tool_json(false);
  const ToolIdentification id = identified(setting);
  EXPECT_NEAR(number(id, "mass_kg").value, 0.75, 0.0075);
  expect_near(number(id, "com_z_m"), 0.16);
  EXPECT_FALSE(id.model.inertia.has_value());
  EXPECT_EQ(id.targets.size(), 3U);
}

TEST(Identify, ColouredNoiseWidensTheIntervals) {
  Setting white, coloured;
  white.simulator = coloured.simulator = identification_tests::tool_json(false);
  coloured.ar = 0.998;  // correlated over 1 s
  const auto narrow = number(identified(white), "mass_kg");
  const auto wide = number(identified(coloured), "mass_kg");
  EXPECT_GT(wide.high - wide.low, 5.0 * (narrow.high - narrow.low));
  expect_near(wide, 0.75);
}

TEST(Identify, FrictionIsFoundAndLeavesTheMassRight) {
  Setting setting;
  setting.hidden = Json::array({Json{{"effect", "coulomb_friction"},
                                     {"axis", "tool_z"},
                                     {"interval_s", nullptr},
                                     {"parameters", {{"fc_n", 0.5}, {"v0_mps", 0.01}}}},
                                Json{{"effect", "viscous_friction"},
                                     {"axis", "tool_z"},
                                     {"interval_s", nullptr},
                                     {"parameters", {{"c_nspm", 3.0}}}}});
  const ToolIdentification id = identified(setting);
  ASSERT_FALSE(id.beside.empty()) << to_text(id);
  EXPECT_EQ(id.beside.front().effect, "friction");
  EXPECT_EQ(id.beside.front().axis, "tool_z");
  EXPECT_NEAR(id.beside.front().parameters.front().value, 0.5, 0.05);
  EXPECT_NEAR(number(id, "mass_kg").value, 0.75, 0.0075);
  EXPECT_NEAR(number(id, "com_z_m").value, 0.16, 0.002);
  IdentifyRequest alone;
  alone.laws = false;
  EXPECT_TRUE(identified(setting, alone).beside.empty());
}

TEST(Identify, ALagOfTheForceIsTakenOff) {
  Setting setting;
  setting.path = identification_tests::trajectory(2.0);
  setting.hidden = Json::array({Json{{"effect", "time_delay"},
                                     {"axis", nullptr},
                                     {"interval_s", nullptr},
                                     {"parameters", {{"delay_s", 0.012}}}}});
  const ToolIdentification id = identified(setting);
  ASSERT_FALSE(id.beside.empty()) << to_text(id);
  EXPECT_EQ(id.beside.front().effect, "time_delay");
  EXPECT_NEAR(id.beside.front().parameters.front().value, 0.012, 0.0005);
  EXPECT_NEAR(number(id, "com_z_m").value, 0.16, 0.001);
}

// As of a reading that its maker filters, or a pose that shakes where the tool does not.
TEST(Identify, LessInertiaThanWeightLeavesTheMassRight) {
  Setting setting;
  setting.simulator = identification_tests::tool_json(false);
  setting.path = identification_tests::trajectory(2.0);
  setting.hidden = Json::array({Json{{"effect", "weightless_mass"},
                                     {"axis", nullptr},
                                     {"interval_s", nullptr},
                                     {"parameters", {{"mass_kg", -0.4}}}}});
  const ToolIdentification id = identified(setting);
  ASSERT_FALSE(id.beside.empty()) << to_text(id);
  EXPECT_EQ(id.beside.front().effect, "weightless_mass");
  EXPECT_NEAR(id.beside.front().parameters.front().value, -0.4, 0.02);
  EXPECT_NEAR(number(id, "mass_kg").value, 0.75, 0.0075);
}

/// A list of poses at rest, every 10 s or so.
Table poses_with_times() {
  Setting setting;
  setting.simulator = identification_tests::tool_json(false);
  setting.samples = 24;
  setting.noise_n = 0.02;
  setting.path = {{"kind", "static"}, {"angle_rad", {3.1, 1.2, 3.1}}};
  Table table = simulated(setting).recordings[0].noisy.table;
  Eigen::MatrixXd values(table.values.rows(), table.values.cols() + 1);
  for (Index k = 0; k < values.rows(); ++k) {
    values(k, 0) = 10.0 * static_cast<double>(k) + (k % 3 == 0 ? 2.5 : 0.0);
  }
  values.rightCols(table.values.cols()) = table.values;
  table.columns.insert(table.columns.begin(), "t");
  table.values = values;
  return table;
}

TEST(Identify, PosesAtRestWithIrregularTimesAreNoMotion) {
  const test::TemporaryFolder folder;
  const Table table = poses_with_times();
  ASSERT_EQ(std::count(table.columns.begin(), table.columns.end(), "t"), 1);
  write_csv(folder / "poses.csv", table);
  IdentifyRequest request;
  request.logs = {folder / "poses.csv"};
  const ToolIdentification id = identify_tool(request);
  EXPECT_NEAR(number(id, "mass_kg").value, 0.75, 0.0075);
  expect_near(number(id, "mounting_rz_rad"), -0.5236);
  EXPECT_FALSE(number(id, "com_z_m").shown);
  EXPECT_TRUE(contains(number(id, "com_z_m").motion, "log torques"));
  EXPECT_EQ(id.model.com, Eigen::Vector3d::Zero());
}

// Seven poses of another day: their offset is theirs, and no noise.
// A robot on a wall: gravity along the base's x axis, and nobody said so.
TEST(Identify, ARobotOnAWallIsFoundToBeOnOne) {
  Setting s;
  s.simulator["sensor"].erase("rotation_rpy");
  s.simulator["gravity_mps2"] = {9.7, 0.0, -1.466};
  s.path = {{"kind", "static"}, {"angle_rad", {1.5, 1.2, 1.5}}, {"angle_center_rad", {0, 0, 0}}};
  s.samples = 24;
  const ToolIdentification id = identified(s);
  EXPECT_NEAR(number(id, "mass_kg").value, 0.75, 0.02);
  EXPECT_NEAR(number(id, "com_z_m").value, 0.16, 0.005);
  EXPECT_LT((id.model.gravity - Eigen::Vector3d(9.7, 0.0, -1.466)).norm(), 0.3);
  bool said = false;
  for (const auto& note : id.notes) said |= note.find("not upright") != std::string::npos;
  EXPECT_TRUE(said);
}

TEST(Identify, AFewPosesWithAnotherOffsetHaveOneOfTheirOwn) {
  const test::TemporaryFolder folder;
  const Table table = poses_with_times();
  Table few = table;
  few.values = table.values.topRows(7);
  const auto at = std::find(few.columns.begin(), few.columns.end(), "fx") - few.columns.begin();
  few.values.middleCols(at, 3).rowwise() += Eigen::RowVector3d(1.3, 1.9, 3.6);
  write_csv(folder / "poses.csv", table);
  write_csv(folder / "few.csv", few);
  IdentifyRequest request;
  request.logs = {folder / "poses.csv", folder / "few.csv"};
  const ToolIdentification id = identify_tool(request);
  ASSERT_FALSE(id.beside.empty()) << to_text(id);
  EXPECT_EQ(id.beside.front().effect, "bias");
  EXPECT_EQ(id.beside.front().axis, "few.csv");
  EXPECT_NEAR(id.beside.front().parameters[2].value, 3.6, 0.05);
}

TEST(Identify, ABodyThatNoMotionShowsCanStillExist) {
  Setting setting;
  setting.path = identification_tests::trajectory(0.1);  // hardly any acceleration
  setting.noise_nm = 0.02;
  const ToolIdentification id = identified(setting);
  EXPECT_FALSE(number(id, "inertia_zz_kgm2").shown);
  EXPECT_TRUE(contains(number(id, "inertia_zz_kgm2").motion, "rad/s^2"));
  EXPECT_TRUE(number(id, "com_z_m").shown);
  EXPECT_GT(number(id, "inertia_zz_kgm2").low, 0.0);
  EXPECT_EQ(assumed(id), std::vector<std::string>{"inertia_kgm2"});
  ASSERT_TRUE(id.model.inertia.has_value());
  EXPECT_GT(id.model.inertia->determinant(), 0.0);
}

// Turned by hand from pose to pose at 10 Hz, the force a mean over the last second: what the tool's
// model leaves is made by the turns and is no noise.
TEST(Identify, ASensorThatFiltersLeavesTheMassRight) {
  constexpr Index kRows = 1800, kHeld = 60, kMean = 10;
  Rng rng({4});
  Table table{{"t", "x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"},
              Eigen::MatrixXd(kRows, 10)};
  Eigen::MatrixXd force(kRows, 3);
  Eigen::Vector3d from(0.1, 0.7, 2.9), to = from;
  for (Index i = 0; i < kRows; ++i) {
    if (i % kHeld == 0) {
      from = to;
      to = Eigen::Vector3d(0.3 * rng.normal(), 0.6 + 0.2 * rng.normal(), 2.9 + 0.3 * rng.normal());
    }
    const double s = std::min(1.0, static_cast<double>(i % kHeld) / 20.0);
    const Eigen::Vector3d angles = from + s * s * (3.0 - 2.0 * s) * (to - from);
    force.row(i) =
        rotation_from_euler(angles).transpose() * Eigen::Vector3d(0.0, 0.0, -1.16 * 9.81);
    const Index last = std::min(i + 1, kMean);
    const Eigen::RowVector3d mean = force.middleRows(i + 1 - last, last).colwise().mean();
    const Eigen::RowVector3d noise(rng.normal(), rng.normal(), rng.normal());
    table.values.row(i) << 0.1 * static_cast<double>(i), 0.3, 0.1, 0.4, angles.transpose(),
        mean + Eigen::RowVector3d(-3.0, -4.8, -16.9) + 0.005 * noise;
  }
  const test::TemporaryFolder folder;
  write_csv(folder / "log.csv", table);
  IdentifyRequest request;
  request.logs = {folder / "log.csv"};
  for (const bool laws : {false, true}) {
    request.laws = laws;
    const ToolIdentification id = identify_tool(request);
    EXPECT_NEAR(number(id, "mass_kg").value, 1.16, 0.023) << to_text(id);
    if (!laws) continue;
    ASSERT_EQ(id.beside.size(), 1U) << to_text(id);
    EXPECT_EQ(id.beside.front().effect, "time_delay") << to_text(id);
    EXPECT_NEAR(id.beside.front().parameters.front().value, 0.45, 0.1);
  }
}

TEST(Identify, TheReactionIsOneLineWithItsRemedy) {
  Setting setting;
  setting.path = {{"kind", "static"}, {"angle_rad", {3.1, 1.2, 3.1}}};
  setting.samples = 24;
  IdentifyRequest request;
  request.read.force_sign = -1.0;
  try {
    identified(setting, request);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kData);
    EXPECT_TRUE(contains(error.what(), "--force-sign")) << error.what();
  }
}

// In a fifth of a second a motion tells fewer readings than the tool has numbers, whose intervals
// would say nothing.
TEST(Identify, AMotionTooShortForSoManyNumbersIsOneLineWithItsRemedy) {
  Setting setting;
  setting.samples = 120;
  try {
    identified(setting);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kData);
    EXPECT_TRUE(contains(error.what(), "too short")) << error.what();
    EXPECT_TRUE(contains(error.what(), "record at least")) << error.what();
  }
  setting.samples = 1500;
  EXPECT_GT(identified(setting).model.mass, 0.0);
}

// Every second such force is a little nearer to left-handed axes, by chance.
TEST(Identify, AForceThatHoldsNoWeightIsNeitherMirroredNorATool) {
  Setting setting;
  setting.simulator = {{"tool", {{"mass_kg", 0.005}, {"com_m", {0.0, 0.0, 0.05}}}}};
  setting.samples = 5000;
  setting.noise_n = 3.0;
  setting.ar = 0.998;  // alike for a second: contacts, a hand
  IdentifyRequest request;
  request.laws = false;
  for (setting.seed = 1; setting.seed <= 4; ++setting.seed) {
    const ToolIdentification id = identified(setting, request);
    ASSERT_FALSE(id.notes.empty());
    EXPECT_TRUE(contains(id.notes.back(), "no rigid tool's")) << id.notes.back();
  }
  EXPECT_FALSE(contains(to_text(identified({}, request)), "no rigid tool's"));
}

// A cable at rest in the middle of a motion far from the angle zero.
TEST(Identify, ACableAddsNoOffset) {
  Setting setting;
  setting.hidden = Json::array({{{"effect", "cable_spring"},
                                 {"axis", "gamma:sensor_y"},
                                 {"parameters", {{"k_nprad", 3.0}, {"rest_rad", 3.14159}}}}});
  const ToolIdentification id = identified(setting);
  ASSERT_EQ(id.beside.size(), 1U);
  EXPECT_EQ(id.beside[0].effect, "cable_spring");
  EXPECT_NEAR(number(id, "bias_y_n").value, -0.4, 0.1);
}

TEST(Identify, SimJsonReadsBackAndPredictsTheLog) {
  const Setting setting;
  const ToolIdentification id = identified(setting);
  const Json json = to_json(Simulator{id.model, {}});
  const Simulator simulator = parse_simulator(json, "sim.json", Exit::kData);
  const Recording log = simulated(setting).recordings[0].noisy;
  const Recording predicted = predict_motion(simulator, log, DerivativeSpec());
  const Eigen::VectorXd error = (predicted.column("fz") - log.column("fz")).segment(250, 14500);
  EXPECT_LT(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())), 0.042);
}

}  // namespace
}  // namespace dcnn
