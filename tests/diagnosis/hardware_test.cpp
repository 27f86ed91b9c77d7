// SPDX-License-Identifier: Apache-2.0
// Laws that hardware has, found on an axis whose position is logged with noise and nothing else of
// its motion; and not found where plain ones act.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "dcnn/core/random.h"
#include "diagnosis/support.h"

namespace dcnn {
namespace {

constexpr double kRate = 250.0, kSensorNoise = 0.05, kPositionNoise = 2e-5;

struct AxisState {
  double t, q, v, a, dt, load;
};

/// What the drive shows beside the load that it carries; called in order of time.
using AxisLaw = std::function<double(const AxisState&)>;

AxisState axis_state(double t) {
  AxisState s{t, 0.0, 0.0, 0.0, 1.0 / kRate, 0.0};
  const double hz[] = {0.07, 0.19, 0.43, 0.83};
  for (int k = 0; k < 4; ++k) {
    const double w = 2.0 * std::numbers::pi * hz[k], phase = 1.3 * k * k, size = 0.8 / (1 + k);
    s.q += size * std::sin(w * t + phase);
    s.v += size * w * std::cos(w * t + phase);
    s.a -= size * w * w * std::sin(w * t + phase);
  }
  s.load = 4.0 * std::cos(s.q) + 0.5 * s.a;  // gravity and inertia
  return s;
}

void write_axis(const std::filesystem::path& path, double begin, const AxisLaw& law,
                std::uint64_t seed) {
  constexpr Index kRows = 7500;
  Rng rng({seed});
  Table table{{"t", "pos", "torque", "simulated"}, Eigen::MatrixXd(kRows, 4)};
  for (Index k = 0; k < kRows; ++k) {
    const AxisState s = axis_state(begin + static_cast<double>(k) / kRate);
    table.values.row(k) << s.t, s.q + kPositionNoise * rng.normal(),
        s.load + law(s) + kSensorNoise * rng.normal(), s.load;
  }
  write_csv(path, table);
}

/// The report on an axis with this law beside what its simulator knows.
Json report_on(const AxisLaw& fit, const AxisLaw& hold, bool simulated = true) {
  const test::TemporaryFolder folder;
  write_axis(folder / "fit.csv", 0.0, fit, 1);
  write_axis(folder / "hold.csv", 40.0, hold, 2);
  Json axis{{"name", "joint"}, {"measured", "torque"}, {"unit", "N*m"}, {"position", "pos"}};
  if (simulated) {
    axis["simulated"] = "simulated";
  } else {
    axis["base"] = Json::array();
  }
  write_file(folder / "system.json", Json{{"kind", "axes"}, {"axes", Json::array({axis})}}.dump());
  DiagnosisRequest request;
  request.system = folder / "system.json";
  request.fit = {folder / "fit.csv"};
  request.holdout = {folder / "hold.csv"};
  return diagnose(request, nullptr).report;
}
Json report_on(const AxisLaw& law) { return report_on(law, law); }

const Json* named(const Json& report, const std::string& effect) {
  for (const Json& f : report["findings"]) {
    if (f["effect"] == effect) return &f;
  }
  return nullptr;
}

double told(const Json& finding, const char* name) {
  return finding["parameters"][name]["value"].get<double>();
}

double dry(double v) { return std::tanh(v / 0.01); }

using test::found;
using Names = std::set<std::string>;

TEST(DiagnoseHardware, PlainFrictionIsNoneOfItsRelatives) {
  const Json report = report_on([](const AxisState& s) { return 0.5 * dry(s.v) + 0.3 * s.v; });
  EXPECT_EQ(found(report), (Names{"coulomb_friction", "viscous_friction"}))
      << report["findings"].dump(1);
}

TEST(DiagnoseHardware, NamesFrictionOfTheLoadBesideDryFriction) {
  const Json report =
      report_on([](const AxisState& s) { return (0.5 + 0.1 * std::abs(s.load)) * dry(s.v); });
  EXPECT_EQ(found(report), (Names{"coulomb_friction", "load_friction"}))
      << report["findings"].dump(1);
  const Json* load = named(report, "load_friction");
  ASSERT_TRUE(load);
  EXPECT_NEAR(told(*load, "mu"), 0.1, 0.01);
}

// Nothing is simulated: what loads the gears is what was found, a weight and an inertia.
TEST(DiagnoseHardware, NamesFrictionOfALoadThatWasFound) {
  const auto drive = [](const AxisState& s) {
    const double carried = 3.0 * std::sin(s.q + 0.4) + 0.5 * s.a;
    return carried - s.load + (0.5 + 0.12 * std::abs(carried)) * dry(s.v);
  };
  const Json report = report_on(drive, drive, /*simulated=*/false);
  EXPECT_EQ(found(report), (Names{"coulomb_friction", "gravity_load", "inertia", "load_friction"}))
      << report["findings"].dump(1);
  const Json* load = named(report, "load_friction");
  ASSERT_TRUE(load);
  EXPECT_NEAR(told(*load, "mu"), 0.12, 0.015);
}

/// Bristles whose strength falls with the speed, as those of most bearings.
AxisLaw falling_bristles(double rise) {
  return [rise, z = 0.0](const AxisState& s) mutable {
    const double reach = 4e-3 * (1.0 + rise * std::exp(-s.v * s.v / 0.01));
    const double end = std::copysign(reach, s.v);
    z = end + (z - end) * std::exp(-std::abs(s.v) * s.dt / reach);
    return 0.8 * z / 4e-3;
  };
}

TEST(DiagnoseHardware, NamesBristlesThatFallWithSpeed) {
  const Json report = report_on(falling_bristles(0.6), falling_bristles(0.6));
  EXPECT_EQ(found(report), Names{"lugre_friction"}) << report["findings"].dump(1);
  const Json* friction = named(report, "lugre_friction");
  ASSERT_TRUE(friction && (*friction)["parameters"].contains("fs")) << report["findings"].dump(1);
  EXPECT_NEAR(told(*friction, "fc"), 0.8, 0.03);
  EXPECT_NEAR(told(*friction, "fs"), 1.28, 0.1);
  EXPECT_NEAR(told(*friction, "vs"), 0.1, 0.02);
  const Json even = report_on(falling_bristles(0.0), falling_bristles(0.0));
  const Json* plain = named(even, "lugre_friction");
  ASSERT_TRUE(plain) << even["findings"].dump(1);
  EXPECT_FALSE((*plain)["parameters"].contains("fs")) << even["findings"].dump(1);
}

TEST(DiagnoseHardware, NamesFrictionThatVariesWithTheGear) {
  const Json report = report_on([](const AxisState& s) {
    return 0.8 * (1.0 + 0.4 * std::sin(9.0 * s.q + 0.5)) * dry(s.v) + 0.3 * s.v;
  });
  EXPECT_EQ(found(report), (Names{"gear_friction", "viscous_friction"}))
      << report["findings"].dump(1);
  const Json* gear = named(report, "gear_friction");
  ASSERT_TRUE(gear);
  EXPECT_NEAR(told(*gear, "fc"), 0.8, 0.03);
  EXPECT_NEAR(told(*gear, "a"), 0.4, 0.04);
  EXPECT_NEAR(told(*gear, "order"), 9.0, 0.05);
}

/// Where the teeth have moved, the friction that they had on the fitted recording is none of
/// theirs: what is left is dry friction.
TEST(DiagnoseHardware, AVariationThatHeldOutDataRefuteIsNone) {
  const auto gears = [](double phase) {
    return [phase](const AxisState& s) {
      return 0.8 * (1.0 + 0.4 * std::sin(9.0 * s.q + phase)) * dry(s.v) + 0.3 * s.v;
    };
  };
  const Json report = report_on(gears(0.5), gears(0.5 + std::numbers::pi));
  EXPECT_EQ(found(report), (Names{"coulomb_friction", "viscous_friction"}))
      << report["findings"].dump(1);
}

/// As in harmonic drives. A drag that does not bend has no such number, above and below.
TEST(DiagnoseHardware, NamesADragThatGrowsSlowerAtSpeed) {
  const Json report = report_on(
      [](const AxisState& s) { return 0.5 * dry(s.v) + 0.8 * s.v / (1.0 + std::abs(s.v) / 1.5); });
  EXPECT_EQ(found(report), (Names{"coulomb_friction", "viscous_friction"}))
      << report["findings"].dump(1);
  const Json* drag = named(report, "viscous_friction");
  ASSERT_TRUE(drag && (*drag)["parameters"].contains("v1")) << report["findings"].dump(1);
  EXPECT_NEAR(told(*drag, "c"), 0.8, 0.05);
  EXPECT_NEAR(told(*drag, "v1"), 1.5, 0.3);
  const Json even = report_on([](const AxisState& s) { return 0.5 * dry(s.v) + 0.6 * s.v; });
  ASSERT_TRUE(named(even, "viscous_friction")) << even["findings"].dump(1);
  EXPECT_FALSE((*named(even, "viscous_friction"))["parameters"].contains("v1"))
      << even["findings"].dump(1);
}

TEST(DiagnoseHardware, NamesFrictionThatDiffersBetweenTheDirections) {
  const Json report = report_on([](const AxisState& s) { return (s.v > 0.0 ? 0.7 : 0.4) * s.v; });
  EXPECT_EQ(found(report), (Names{"asymmetric_friction", "viscous_friction"}))
      << report["findings"].dump(1);
}

TEST(DiagnoseHardware, NamesASpringThatBendsToOneSideAndAPlainOne) {
  const Json bent =
      report_on([](const AxisState& s) { return 0.6 * s.q + 0.5 * s.q * s.q + 0.5 * dry(s.v); });
  EXPECT_EQ(found(bent), (Names{"cable_spring", "coulomb_friction", "quadratic_spring"}))
      << bent["findings"].dump(1);
  if (const Json* spring = named(bent, "quadratic_spring")) {
    EXPECT_NEAR(told(*spring, "k2"), 0.5, 0.03);
  }
  const Json plain =
      report_on([](const AxisState& s) { return 0.6 * (s.q - 0.2) + 0.5 * dry(s.v); });
  EXPECT_EQ(found(plain), (Names{"cable_spring", "coulomb_friction"})) << plain["findings"].dump(1);
}

TEST(DiagnoseHardware, NamesTheWeightOfALoadOffTheAxis) {
  const AxisLaw hanging = [](const AxisState& s) {
    return 1.2 * std::sin(s.q - 0.3) + 0.5 * dry(s.v);
  };
  const Json report = report_on(hanging, hanging);
  EXPECT_EQ(found(report), (Names{"coulomb_friction", "gravity_load"}))
      << report["findings"].dump(1);
  if (const Json* load = named(report, "gravity_load")) {
    EXPECT_NEAR(told(*load, "amp"), 1.2, 0.03);
    EXPECT_NEAR(told(*load, "rest"), 0.3, 0.03);
  }
}

/// Bouc and Wen's z by Euler's steps, beta 1, over a width of 0.5 rad.
AxisLaw boucwen(double gamma) {
  return [gamma, z = 0.0, before = std::optional<double>()](const AxisState& s) mutable {
    for (int i = 0; i < 20 && before; ++i) {
      const double du = (s.q - *before) / 0.5 / 20.0;
      z += du - std::abs(du) * z - gamma * du * std::abs(z);
    }
    before = s.q;
    return 1.5 * z;
  };
}

TEST(DiagnoseHardware, NamesAHysteresisOfTheOtherSign) {
  const Json report = report_on(boucwen(-1.3), boucwen(-1.3));
  EXPECT_EQ(found(report), Names{"hysteresis"}) << report["findings"].dump(1);
  const Json* cable = named(report, "hysteresis");
  ASSERT_TRUE(cable);
  ASSERT_TRUE((*cable)["parameters"].contains("gamma")) << cable->dump(1);
  EXPECT_NEAR(told(*cable, "gamma"), -1.3, 0.1);
}

/// The part of the load that a sensor shows late.
AxisLaw creeping(double a, double tau) {
  return [=, s = std::optional<double>()](const AxisState& now) mutable {
    s = s ? *s + now.dt / tau * (now.load - *s) : now.load;
    return a * *s;
  };
}

TEST(DiagnoseHardware, NamesAReadingThatGoesOnSettling) {
  const Json report = report_on(creeping(0.2, 1.5), creeping(0.2, 1.5));
  EXPECT_EQ(found(report), Names{"creep"}) << report["findings"].dump(1);
  const Json* creep = named(report, "creep");
  ASSERT_TRUE(creep);
  EXPECT_NEAR(told(*creep, "a"), 0.2, 0.02);
  EXPECT_NEAR(told(*creep, "tau"), 1.5, 0.2);
}

TEST(DiagnoseHardware, NamesTheFrictionOfAToolPressedOnItsGuide) {
  const Json of_load = test::hidden("load_friction", "base_z", {{"mu", 0.05}, {"v0_mps", 0.01}});
  const Json report = test::Bench(test::configuration(Json::array({of_load}))).diagnose().report;
  EXPECT_EQ(found(report), Names{"load_friction"}) << report["findings"].dump(1);
  const Json plain = test::hidden("coulomb_friction", "base_z", {{"fc_n", 0.2}, {"v0_mps", 0.01}});
  const Json dry_report = test::Bench(test::configuration(Json::array({plain}))).diagnose().report;
  EXPECT_EQ(found(dry_report), Names{"coulomb_friction"}) << dry_report["findings"].dump(1);
}

}  // namespace
}  // namespace dcnn
