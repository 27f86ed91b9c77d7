// SPDX-License-Identifier: Apache-2.0
// States of a law that are means of many, and the presliding of a direction: closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/physics/law.h"
#include "physics/support.h"
#include "support/no_allocation.h"

namespace dcnn {
namespace {

constexpr int kMany = 8;  // of which a mean is taken

law::Law read_law(const char* structure, const Json& numbers) {
  Options text(Json::parse(structure), "test", Exit::kUsage), list(numbers, "test", Exit::kUsage);
  return law::parse_law(law::parse_structure(text), list);
}

Wrench force_of(const char* structure, const Json& numbers, const Motion& motion) {
  const auto effect = make_effect("discovered", "", numbers, nullptr, structure);
  return applied(effect, motion, no_wrench(motion.samples()));
}

/// One that has all of them.
law::Law law_of_all() {
  return read_law(
      R"({"axis": "along_velocity", "direction_presliding": true, "lagged": true, "lag_spread": true,
          "factors": [{"shape": "linear", "of": "x", "memory": "plays"},
                      {"shape": "linear", "of": "y", "memory": "lags"}]})",
      {{"amplitude_n", 1.0},
       {"vector_length_m", 0.01},
       {"lag_s", 0.5},
       {"lag_spread", 10.0},
       {"memory_1_m", 0.02},
       {"scale_1_m", 0.1},
       {"memory_2_s", 2.0},
       {"spread_2", 20.0},
       {"scale_2_m", 0.1}});
}

/// Times at the middles of even intervals of a log scale.
double mean_of_steps(double t, double tau, double spread) {
  double sum = 0.0;
  for (int k = 0; k < kMany; ++k) {
    const double own = tau * std::pow(spread, (k + 0.5) / kMany - 0.5);
    sum += 1.0 - std::exp(-t / own);
  }
  return sum / kMany;
}

TEST(LawSpectra, ManyLagsAreTheMeanOfTheirStepResponses) {
  constexpr Index kSamples = 2000;
  Motion motion = still_motion(kSamples, 0.002);
  motion.v_B.col(0).tail(kSamples - 1).setOnes();
  const Wrench of_state = force_of(
      R"({"axis": "base_x", "factors": [{"shape": "linear", "of": "v_base_x", "memory": "lags"}]})",
      {{"amplitude_n", 2.0}, {"memory_1_s", 0.4}, {"spread_1", 50.0}, {"scale_1_mps", 1.0}},
      motion);
  const Wrench of_product = force_of(
      R"({"axis": "base_x", "lagged": true, "lag_spread": true,
          "factors": [{"shape": "linear", "of": "v_base_x"}]})",
      {{"amplitude_n", 2.0}, {"lag_s", 0.4}, {"lag_spread", 50.0}, {"scale_1_mps", 1.0}}, motion);
  for (Index k = 20; k < kSamples; ++k) {  // the first step is a ramp of one sample
    const double t = (static_cast<double>(k) - 0.5) * 0.002;
    ASSERT_NEAR(of_state.force(k, 0), 2.0 * mean_of_steps(t, 0.4, 50.0), 2e-4);
    ASSERT_DOUBLE_EQ(of_product.force(k, 0), of_state.force(k, 0));
  }
}

TEST(LawSpectra, ManyPlaysGiveTheParabolaOfTheirVirginCurve) {
  // Of widths that are evenly spread up to w, a displacement x moves those below x:
  // the mean is x^2/(2 w), and (x - w/2) once all have moved (Iwan 1966).
  constexpr Index kSamples = 400;
  const double width = 0.04;
  Motion motion = still_motion(kSamples, 0.01);
  for (Index k = 0; k < kSamples; ++k) motion.p_B(k, 0) = 2e-4 * static_cast<double>(k);
  const Wrench wrench = force_of(
      R"({"axis": "base_x", "factors": [{"shape": "linear", "of": "x", "memory": "plays"}]})",
      {{"amplitude_n", 1.0}, {"memory_1_m", width}, {"scale_1_m", 1.0}}, motion);
  const double step = width / kMany;
  for (Index k = 0; k < kSamples; ++k) {
    const double x = motion.p_B(k, 0);
    const double smooth = x < width ? 0.5 * x * x / width : x - 0.5 * width;
    ASSERT_NEAR(wrench.force(k, 0), smooth, step / (8.0 * kMany) + 1e-12);
  }
}

TEST(LawSpectra, PreslidingOfTheDirectionIsExponentialInThePathAndStaysInTheBase) {
  constexpr Index kSamples = 600;
  const double dt = 0.002, length = 0.004, speed = 0.03;
  Motion motion = still_motion(kSamples, dt);
  for (Index k = 0; k < kSamples; ++k) {
    if (k < 300) motion.v_B.row(k) = Eigen::RowVector3d(0.0, speed, 0.0);
    const double angle = k < 300 ? 0.0 : 0.005 * static_cast<double>(k - 300);
    motion.R_BS[static_cast<std::size_t>(k)] =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
  const char* const structure =
      R"({"axis": "along_velocity", "direction_presliding": true, "factors": []})";
  const Wrench wrench =
      force_of(structure, {{"amplitude_n", -1.5}, {"vector_length_m", length}}, motion);
  for (Index k = 0; k < 300; ++k) {
    const double path = speed * dt * static_cast<double>(k);
    ASSERT_NEAR(wrench.force(k, 1), -1.5 * (1.0 - std::exp(-path / length)), 1e-12);
  }
  for (Index k = 300; k < kSamples; ++k) {  // at rest it stays, while the sensor turns
    const Eigen::Vector3d in_base =
        motion.R_BS[static_cast<std::size_t>(k)] * wrench.force.row(k).transpose();
    ASSERT_NEAR(in_base[1], wrench.force(299, 1), 1e-12);
    ASSERT_NEAR(in_base[0], 0.0, 1e-12);
  }
  EXPECT_EQ(law::words(read_law(structure, {{"amplitude_n", -1.5}, {"vector_length_m", length}})),
            "a force against the direction of motion, which builds up over 0.004 m of the path: "
            "1.5 N");
}

TEST(LawSpectra, AStopIsElasticAndThenSlips) {
  constexpr Index kSamples = 300;
  Motion motion = still_motion(kSamples, 0.01);
  for (Index k = 0; k < kSamples; ++k) {
    motion.p_B(k, 0) = 1e-3 * static_cast<double>(k < 101 ? k : 200 - std::min<Index>(k, 180));
  }
  const Wrench wrench = force_of(
      R"({"axis": "base_x", "factors": [{"shape": "linear", "of": "x", "memory": "stop"}]})",
      {{"amplitude_n", 2.0}, {"memory_1_m", 0.03}, {"scale_1", 1.0}}, motion);
  EXPECT_NEAR(wrench.force(15, 0), 2.0 * 0.5, 1e-12);
  EXPECT_NEAR(wrench.force(99, 0), 2.0, 1e-12);
  EXPECT_NEAR(wrench.force(115, 0), 2.0 * (0.03 - 0.015) / 0.03, 1e-12);  // back by 15 mm
  EXPECT_NEAR(wrench.force(299, 0), -2.0, 1e-12);
}

TEST(LawSpectra, TakeALoggedColumnThatIsCalledAsACoordinateIs) {
  const char* const structure = R"({"axis": "base_x", "signals": ["load"],
                                    "factors": [{"shape": "power", "of": "signal_1"}]})";
  const Json numbers{{"amplitude_n", 2.0}, {"scale_1", 4.0}, {"power_1", 1.5}};
  Motion motion = still_motion(3, 0.01);
  motion.signals = {{"load", Eigen::Vector3d(0.0, 4.0, 16.0)}};
  const Wrench wrench = force_of(structure, numbers, motion);
  EXPECT_NEAR(wrench.force(1, 0), 2.0, 1e-12);
  EXPECT_NEAR(wrench.force(2, 0), 16.0, 1e-12);
  const law::Law law = read_law(structure, numbers);
  EXPECT_EQ(
      law::words(law),
      "a force along the base's x axis, growing as the 1.5th power of the logged load: 2 N at "
      "4 of the logged load");
  Options again(law::to_json(law), "test", Exit::kUsage);
  EXPECT_EQ(law::parse_structure(again), law.structure);
  motion.signals.clear();
  try {
    force_of(structure, numbers, motion);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("column 'load'"), std::string::npos) << error.what();
  }
}

TEST(LawSpectra, StandInFilesAndAreRefusedWhereTheyMeanNothing) {
  const std::vector<std::pair<const char*, const char*>> refused{
      {R"({"axis": "base_x", "direction_presliding": true, "factors": []})", "along_velocity"},
      {R"({"axis": "velocity", "lag_spread": true, "factors": []})", "needs 'lagged'"}};
  for (const auto& [text, reason] : refused) {
    Options options(Json::parse(text), "test", Exit::kUsage);
    try {
      law::parse_structure(options);
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }
  const law::Law law = law_of_all();
  Options again(law::to_json(law), "test", Exit::kUsage);
  EXPECT_EQ(law::parse_structure(again), law.structure);
  EXPECT_EQ(law::expression(law),
            "lags(1 N * [(plays(x, 0.02 m)/(0.1 m))] * [(lags(y, 2 s, 20)/(0.1 m))], 0.5 s, 10) "
            "along presliding(along_velocity, 0.01 m)");
}

TEST(LawSpectra, StepWithoutAllocating) {
  if (!test::HeapCounter::works()) GTEST_SKIP() << "heap calls are not seen here";
  law::LawRun run(law_of_all());
  law::Sample now;
  now.euler = now.v_B = now.a_B = now.w_S = now.dw_S = now.load_S = Eigen::Vector3d::Zero();
  const test::HeapCounter counter;
  for (int k = 0; k < 3000; ++k) {
    now.p_B = {0.1 * std::sin(0.01 * k), 0.1 * std::sin(0.013 * k), 0.0};
    now.v_B = {std::cos(0.01 * k), 0.0, 0.0};
    run.step(now, 0.001, k == 0);
  }
  EXPECT_EQ(test::HeapCounter::allocations(), 0);
}

}  // namespace
}  // namespace dcnn
