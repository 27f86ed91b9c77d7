// SPDX-License-Identifier: Apache-2.0
// Laws as data: closed forms, files, units and words.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "dcnn/physics/law.h"
#include "dcnn/physics/streaming_simulator.h"
#include "physics/support.h"
#include "support/no_allocation.h"

namespace dcnn {
namespace {

EffectSpec discovered(const char* law, const Json& parameters) {
  return make_effect("discovered", "", parameters, nullptr, law);
}

std::string refusal_of(const char* law, const Json& parameters) {
  try {
    discovered(law, parameters);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

law::Law law_of(const EffectSpec& spec) {
  Options structure(spec.law, "test", Exit::kUsage),
      parameters(spec.parameters, "test", Exit::kUsage);
  return law::parse_law(law::parse_structure(structure), parameters);
}

/// Moves along base x with this velocity; S = B.
Motion moving(const Eigen::VectorXd& v, double dt) {
  Motion motion = still_motion(v.size(), dt);
  motion.v_B.col(0) = v;
  return motion;
}

TEST(DiscoveredLaw, ProductOfAPowerAndAModulationIsItsClosedForm) {
  const Motion motion = example_motion(400);
  const auto effect = discovered(
      R"({"axis": "base_y", "factors": [{"shape": "power", "of": "v_base_x"},
          {"shape": "affine", "of": "gamma", "centred": true}]})",
      {{"amplitude_n", -3.1},
       {"scale_1_mps", 0.1},
       {"power_1", 1.5},
       {"centre_2_rad", 0.2},
       {"scale_2_rad", 1.0},
       {"gain_2", 0.7}});
  const Wrench wrench = applied(effect, motion, no_wrench(400));
  for (Index k = 0; k < 400; ++k) {
    const double u = motion.v_B(k, 0) / 0.1;
    const double size = -3.1 * std::copysign(std::pow(std::abs(u), 1.5), u) *
                        (1.0 + 0.7 * (motion.euler(k, 2) - 0.2));
    const Eigen::Vector3d n = motion.R_BS[static_cast<std::size_t>(k)].row(1);
    ASSERT_LT((wrench.force.row(k).transpose() - size * n).norm(), 1e-12);
  }
}

TEST(DiscoveredLaw, DahlStateIsExponentialInThePath) {
  const double v = 0.02, width = 3e-3;
  const auto effect = discovered(R"({"axis": "base_x",
                     "factors": [{"shape": "linear", "of": "v_base_x", "memory": "dahl"}]})",
                                 {{"amplitude_n", -0.5}, {"memory_1_m", width}, {"scale_1", 1.0}});
  const Wrench wrench =
      applied(effect, moving(Eigen::VectorXd::Constant(200, v), 0.002), no_wrench(200));
  for (Index k = 0; k < 200; ++k) {
    const double path = v * 0.002 * static_cast<double>(k);
    ASSERT_NEAR(wrench.force(k, 0), -0.5 * (1.0 - std::exp(-path / width)), 1e-12);
  }
}

TEST(DiscoveredLaw, OutputLagIsTheStepResponseOfAFirstOrderLag) {
  Eigen::VectorXd v = Eigen::VectorXd::Ones(500);
  v(0) = 0.0;
  const auto effect = discovered(R"({"axis": "base_x", "lagged": true,
                     "factors": [{"shape": "linear", "of": "v_base_x"}]})",
                                 {{"amplitude_n", 2.0}, {"lag_s", 0.25}, {"scale_1_mps", 1.0}});
  const Wrench wrench = applied(effect, moving(v, 0.002), no_wrench(500));
  EXPECT_NEAR(wrench.force(499, 0), 2.0 * (1.0 - std::exp(-0.997 / 0.25)), 1e-4);
}

TEST(DiscoveredLaw, SecondOrderIsItsStepResponse) {
  Eigen::VectorXd v = Eigen::VectorXd::Ones(1500);
  v(0) = 0.0;
  const double hz = 1.3, damping = 0.15, dt = 0.002;
  const auto effect = discovered(
      R"({"axis": "base_x",
          "factors": [{"shape": "linear", "of": "v_base_x", "memory": "second_order"}]})",
      {{"amplitude_n", 2.0}, {"memory_1_hz", hz}, {"damping_1", damping}, {"scale_1_mps", 1.0}});
  const Wrench wrench = applied(effect, moving(v, dt), no_wrench(1500));
  // The first step is a ramp of one sample: a step half a sample later but for terms of dt^2.
  const double w = 2.0 * M_PI * hz, wd = w * std::sqrt(1.0 - damping * damping);
  for (Index k = 10; k < 1500; ++k) {
    const double t = (static_cast<double>(k) - 0.5) * dt;
    const double step =
        1.0 - std::exp(-damping * w * t) * (std::cos(wd * t) + damping * w / wd * std::sin(wd * t));
    ASSERT_NEAR(wrench.force(k, 0), 2.0 * step, 1e-4);
  }
}

TEST(DiscoveredLaw, AThixotropicStateFallsToItsEquilibriumAndRecoversAtRest) {
  const double v = 0.05, length = 0.02, recovery = 3.0, dt = 0.002;
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(3000);
  motion.segment(1, 1000).setConstant(v);  // after a rest of any length, and before another
  const auto effect = discovered(
      R"({"axis": "base_x",
          "factors": [{"shape": "linear", "of": "v_base_x", "memory": "thixotropic"}]})",
      {{"amplitude_n", 2.0}, {"memory_1_m", length}, {"recovery_1_s", recovery}, {"scale_1", 1.0}});
  const Wrench wrench = applied(effect, moving(motion, dt), no_wrench(3000));
  EXPECT_EQ(wrench.force(0, 0), 2.0);
  const double rate = 1.0 / recovery + v / length, settled = 1.0 / (recovery * rate);
  for (Index k = 1; k <= 1000; ++k) {  // the first step is a ramp: half of one
    const double t = (static_cast<double>(k) - 0.5) * dt;
    ASSERT_NEAR(wrench.force(k, 0), 2.0 * (settled + (1.0 - settled) * std::exp(-rate * t)), 1e-4);
  }
  for (Index k = 1002; k < 3000; ++k) {
    const double t = static_cast<double>(k - 1001) * dt;
    const double left = 1.0 - 0.5 * wrench.force(1001, 0);
    ASSERT_NEAR(wrench.force(k, 0), 2.0 * (1.0 - left * std::exp(-t / recovery)), 1e-9);
  }
  // One that begins in motion has moved so for long.
  const Wrench steady =
      applied(effect, moving(Eigen::VectorXd::Constant(100, v), dt), no_wrench(100));
  for (Index k = 0; k < 100; ++k) ASSERT_NEAR(steady.force(k, 0), 2.0 * settled, 1e-12);
}

// s' = (q - s)/tau after a step of q: 1 - exp(-t/rising), and exp(-t/falling) after it ends.
TEST(DiscoveredLaw, AnUnevenLagRisesInOneTimeAndFallsInAnother) {
  constexpr double dt = 0.001, rising = 0.05, falling = 0.4;
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(2000);
  motion.segment(1, 1000).setOnes();
  const auto effect = discovered(
      R"({"axis": "base_x",
          "factors": [{"shape": "linear", "of": "v_base_x", "memory": "uneven_lag"}]})",
      {{"amplitude_n", 2.0},
       {"memory_1_s", rising},
       {"falling_1_s", falling},
       {"scale_1_mps", 1.0}});
  const Wrench wrench = applied(effect, moving(motion, dt), no_wrench(2000));
  for (Index k = 1; k < 2000; ++k) {  // a step between two samples is a ramp: half a step late
    const double t = (static_cast<double>(k > 1000 ? k - 1000 : k) - 0.5) * dt;
    const double force = k > 1000 ? std::exp(-t / falling) : 1.0 - std::exp(-t / rising);
    ASSERT_NEAR(wrench.force(k, 0), 2.0 * force, 2e-3) << k;
  }
}

// A state of f(u): of |v| it does not change where the motion turns, |state of v| does.
TEST(DiscoveredLaw, AStateMayBeOfTheShape) {
  constexpr double dt = 0.001, tau = 0.3;
  const Eigen::VectorXd motion = (Eigen::ArrayXd::LinSpaced(3000, 0.0, 60.0).sin() > 0.0)
                                     .select(Eigen::VectorXd::Ones(3000), -1.0);
  for (const bool of_shape : {false, true}) {
    Json factor{{"shape", "even_power"}, {"of", "v_base_x"}, {"memory", "lag"}};
    if (of_shape) factor["remembered"] = true;
    const auto effect = discovered(
        Json{{"axis", "base_x"}, {"factors", Json::array({factor})}}.dump().c_str(),
        {{"amplitude_n", 2.0}, {"memory_1_s", tau}, {"scale_1_mps", 1.0}, {"power_1", 1.0}});
    const Wrench wrench = applied(effect, moving(motion, dt), no_wrench(3000));
    const double least = wrench.force.col(0).tail(2000).minCoeff();
    EXPECT_EQ(least > 1.99, of_shape) << least;
    EXPECT_EQ(law::to_json(law_of(effect))["factors"][0].contains("remembered"), of_shape);
  }
  EXPECT_NE(refusal_of(R"({"axis": "base_x", "factors": [
                {"shape": "tanh", "of": "v_base_x", "memory": "dahl", "remembered": true}]})",
                       {{"amplitude_n", 1.0}, {"memory_1_m", 0.1}, {"scale_1", 0.1}})
                .find("needs a memory of time"),
            std::string::npos);
}

TEST(DiscoveredLaw, ADelayIsTheMotionAsItWas) {
  Eigen::VectorXd v = Eigen::ArrayXd::LinSpaced(2000, 0.0, 5.0).sin();
  for (const double delay : {0.0007, 0.0123, 0.31}) {  // less than a sample, and of thinned samples
    const auto effect = discovered(
        R"({"axis": "base_x", "factors": [{"shape": "linear", "of": "v_base_x", "memory": "delay"}]})",
        {{"amplitude_n", 2.0}, {"memory_1_s", delay}, {"scale_1_mps", 1.0}});
    const double dt = 0.0001;
    const Wrench wrench = applied(effect, moving(v, dt), no_wrench(2000));
    for (Index k = 0; k < 2000; ++k) {
      const double before = std::max(0.0, static_cast<double>(k) - delay / dt);
      ASSERT_NEAR(wrench.force(k, 0), 2.0 * std::sin(5.0 * before / 1999.0), 1e-4);
    }
  }
}

TEST(DiscoveredLaw, ACurveGoesThroughItsValuesAndIsCubicBetween) {
  // A parabola: between inner nodes the cubic of Catmull and Rom is exact for it.
  const auto parabola = [](double u) { return 1.0 - 0.8 * u * u; };
  Json numbers{{"amplitude_n", 3.0}, {"centre_1_m", 0.2}, {"scale_1_m", 0.1}};
  for (int k = 0; k < 9; ++k) {
    numbers["value_1_" + std::to_string(k + 1)] = parabola(-1.0 + 0.25 * k);
  }
  const auto effect = discovered(
      R"({"axis": "base_x",
          "factors": [{"shape": "curve", "of": "x", "centred": true, "nodes": 9, "peak": 4}]})",
      numbers);
  Motion motion = still_motion(601);
  motion.p_B.col(0) = Eigen::ArrayXd::LinSpaced(601, 0.05, 0.35);
  const Wrench wrench = applied(effect, motion, no_wrench(601));
  for (Index k = 0; k < 601; ++k) {
    const double u = (motion.p_B(k, 0) - 0.2) / 0.1;
    const double at = std::abs(u) <= 0.75 ? u : 1.0;  // the ends' slopes are one-sided
    if (at == u || std::abs(u) >= 1.0) {
      ASSERT_NEAR(wrench.force(k, 0), 3.0 * parabola(at), 1e-9);
    }
  }
  const Json told = law::to_json(law_of(effect));
  EXPECT_NE(told["expression"].get<std::string>().find("curve(x; 0.1: 0.2, 0.125: 0.55"),
            std::string::npos);
  EXPECT_NE(told["words"].get<std::string>().find("100 % at 0.2 m"), std::string::npos);
}

TEST(DiscoveredLaw, PlayLeavesADeadZoneAtEveryTurn) {
  Motion motion = still_motion(300);
  motion.euler.col(1) = Eigen::ArrayXd::LinSpaced(300, 0.0, 12.0).sin();
  const auto effect = discovered(
      R"({"axis": "tool_z", "factors": [{"shape": "linear", "of": "beta", "memory": "play"}]})",
      {{"amplitude_n", 1.0}, {"memory_1_rad", 0.1}, {"scale_1_rad", 1.0}});
  const Wrench wrench = applied(effect, motion, no_wrench(300));
  EXPECT_NEAR(wrench.force.col(2).maxCoeff(), 0.9, 1e-3);
  EXPECT_NEAR(wrench.force.col(2).minCoeff(), -0.9, 1e-3);
}

TEST(DiscoveredLaw, LoadIsTheForceThatItIsAddedTo) {
  const Motion motion = example_motion(100);
  const auto effect = discovered(R"({"axis": "load", "factors": []})",
                                 {{"amplitude_n", 0.5}, {"vector_scale_n", 10.0}});
  const Wrench before = rigid_wrench(example_tool(), motion);
  EXPECT_LT((applied(effect, motion, before).force - 1.05 * before.force).norm(), 1e-9);
}

TEST(DiscoveredLaw, ObliqueAxisIsTheNormalisedSumOfAxes) {
  const Motion motion = example_motion(300);
  const auto effect = discovered(
      R"({"axis": "base_y", "oblique": true, "factors": [{"shape": "tanh", "of": "v_along"},
          {"shape": "affine", "of": "p_along", "centred": true}]})",
      {{"amplitude_n", -0.7},
       {"axis_z", 0.5},
       {"axis_x", -2.0},
       {"scale_1_mps", 0.02},
       {"centre_2_m", 0.1},
       {"scale_2_m", 0.2},
       {"gain_2", 0.4}});
  const Eigen::Vector3d e = Eigen::Vector3d(-2.0, 1.0, 0.5).normalized();
  const Wrench wrench = applied(effect, motion, no_wrench(300));
  for (Index k = 0; k < 300; ++k) {
    const double size = -0.7 * std::tanh(e.dot(motion.v_B.row(k)) / 0.02) *
                        (1.0 + 0.4 * (e.dot(motion.p_B.row(k)) - 0.1) / 0.2);
    const Eigen::Vector3d n = motion.R_BS[static_cast<std::size_t>(k)].transpose() * e;
    ASSERT_LT((wrench.force.row(k).transpose() - size * n).norm(), 1e-12);
  }
  EXPECT_EQ(law::words(law_of(effect)).substr(0, 73),
            "a force against the motion along the axis (-0.873, 0.436, 0.218) of the b");
  EXPECT_NE(law::expression(law_of(effect)).find("along base(-0.873, 0.436, 0.218)"),
            std::string::npos);
}

TEST(DiscoveredLaw, CentralFieldFallsWithTheDistanceFromItsPoint) {
  const Motion motion = example_motion(300);
  const auto effect = discovered(
      R"({"axis": "from_point", "factors": [{"shape": "inverse_power", "of": "distance"}]})",
      {{"amplitude_n", -0.3},
       {"point_x_m", 0.4},
       {"point_y_m", 0.2},
       {"point_z_m", -0.3},
       {"scale_1_m", 0.1},
       {"power_1", 3.0}});
  const Eigen::Vector3d point(0.4, 0.2, -0.3);
  const Wrench wrench = applied(effect, motion, no_wrench(300));
  for (Index k = 0; k < 300; ++k) {
    const Eigen::Vector3d d = motion.p_B.row(k).transpose() - point;
    const Eigen::Vector3d f =
        motion.R_BS[static_cast<std::size_t>(k)].transpose() * d / std::pow(d.norm(), 4);
    ASSERT_LT((wrench.force.row(k).transpose() + 0.3e-3 * f).norm(), 1e-12);
  }
  EXPECT_EQ(law::words(law_of(effect)),
            "a force towards the point (0.4, 0.2, -0.3) m of the base, falling as the 3rd power of "
            "the distance from it: 0.3 N at 0.1 m of the distance from it");
}

TEST(DiscoveredLaw, NumbersOfTheDirectionStandInFiles) {
  for (const char* law : {R"({"axis": "velocity_cross_base_z", "oblique": true, "factors": []})",
                          R"({"axis": "tool_z", "oblique": true, "lagged": true,
                              "factors": [{"shape": "linear", "of": "w_along"}]})",
                          R"({"axis": "from_point", "direction_lagged": true,
                              "factors": [{"shape": "linear", "of": "distance"}]})"}) {
    Options text(Json::parse(law), "test", Exit::kUsage);
    law::Law before{law::parse_structure(text), {}};
    const auto list = law::numbers_of(before.structure);
    before.numbers = Eigen::VectorXd::LinSpaced(static_cast<Index>(list.size()), 0.5, 1.5);
    const law::Law after = law_of(make_effect("discovered", "", law::parameters_json(before),
                                              nullptr, law::to_json(before).dump().c_str()));
    EXPECT_EQ(after.structure, before.structure);
    EXPECT_EQ(after.numbers, before.numbers);
  }
}

TEST(DiscoveredLaw, RefusesWhatItsDirectionDoesNotHave) {
  EXPECT_NE(
      refusal_of(R"({"axis": "base_x", "factors": [{"shape": "linear", "of": "distance"}]})", {})
          .find("'distance' needs the axis from_point, not 'base_x'"),
      std::string::npos);
  EXPECT_NE(refusal_of(R"({"axis": "load", "factors": [{"shape": "linear", "of": "v_along"}]})", {})
                .find("'v_along' needs an axis"),
            std::string::npos);
  EXPECT_NE(refusal_of(R"({"axis": "velocity", "oblique": true, "factors": []})", {})
                .find("of axes, not of 'velocity'"),
            std::string::npos);
}

TEST(DiscoveredLaw, StreamsWithoutAllocating) {
  const EffectSpec effect = example_effect(*find_effect("discovered"));
  if (!test::HeapCounter::works()) GTEST_SKIP() << "heap calls are not seen here";
  StreamingSimulator simulator({example_tool(), {effect}}, causal_derivative(), 0.002, "test",
                               Exit::kUsage);
  for (int k = 0; k < 200; ++k) simulator.push({0.01 * k, 0.0, 0.0}, Eigen::Vector3d(0, 0, 0));
  const test::HeapCounter counter;
  for (int k = 200; k < 400; ++k) simulator.push({0.01 * k, 0.0, 0.0}, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(test::HeapCounter::allocations(), 0);
}

TEST(DiscoveredLaw, TablesAndDelaysStepWithoutAllocating) {
  if (!test::HeapCounter::works()) GTEST_SKIP() << "heap calls are not seen here";
  Json numbers{{"amplitude_n", 1.0}, {"memory_1_s", 0.3},  {"centre_1_m", 0.0},
               {"scale_1_m", 0.1},   {"scale_2_mps", 0.1}, {"memory_2_s", 0.05}};
  for (int k = 1; k <= 5; ++k) numbers["value_1_" + std::to_string(k)] = 0.2 * k;
  law::LawRun run(law_of(discovered(
      R"({"axis": "base_x", "factors": [
          {"shape": "curve", "of": "x", "memory": "delay", "centred": true, "nodes": 5, "peak": 4},
          {"shape": "step", "of": "v_base_x", "memory": "delay"}]})",
      numbers)));
  law::Sample now;
  now.euler = now.v_B = now.a_B = now.w_S = now.dw_S = now.load_S = Eigen::Vector3d::Zero();
  const test::HeapCounter counter;
  for (int k = 0; k < 3000; ++k) {
    now.p_B = {0.1 * std::sin(0.01 * k), 0.0, 0.0};
    run.step(now, 0.001, k == 0);
  }
  EXPECT_EQ(test::HeapCounter::allocations(), 0);
}

TEST(DiscoveredLaw, OnTheClockItDoesNotRunOnline) {
  const auto effect =
      discovered(R"({"axis": "base_x", "factors": [{"shape": "exponential", "of": "t"}]})",
                 {{"amplitude_n", 1.0}, {"scale_1_s", 20.0}});
  std::vector<std::string> left_out;
  EXPECT_TRUE(online_part({example_tool(), {effect}}, left_out).effects.empty());
  EXPECT_EQ(left_out, std::vector<std::string>{"discovered"});
}

TEST(DiscoveredLaw, FilesGiveItBackAndTellItAgain) {
  const EffectSpec effect = example_effect(*find_effect("discovered"));
  const law::Law law = law_of(effect);
  EffectSpec told = effect;
  told.law = law::to_json(law);
  told.parameters = law::parameters_json(law);
  const Json json = to_json(std::vector<EffectSpec>{told})[0];
  const law::Law again =
      law_of(parse_effects(Json::array({json}), "model.json", Exit::kModel).front());
  EXPECT_EQ(again.structure, law.structure);
  EXPECT_EQ(again.numbers, law.numbers);
  EXPECT_EQ(json["law"]["coordinates"][0]["frame"].get<std::string>(), "tool");
  EXPECT_EQ(json["law"]["states"][0]["kind"].get<std::string>(), "lag");
}

TEST(DiscoveredLaw, IsToldInWordsTextAndLatex) {
  const auto law =
      law_of(discovered(R"({"axis": "tool_z", "factors": [{"shape": "power", "of": "v_tool_z"}]})",
                        {{"amplitude_n", -3.1}, {"scale_1_mps", 0.1}, {"power_1", 1.5}}));
  EXPECT_EQ(law::words(law),
            "a force against the motion along the tool, growing as the 1.5th power of the velocity "
            "along the tool: 3.1 N at 0.1 m/s of the velocity along the tool");
  EXPECT_EQ(law::expression(law),
            "-3.1 N * [sgn (v_tool_z/(0.1 m/s)) |(v_tool_z/(0.1 m/s))|^1.5] along tool_z");
  EXPECT_NE(
      law::latex(law).find("\\left|\\tfrac{v_{\\text{tool z}}}{0.1\\,\\mathrm{m/s}}\\right|^{1.5}"),
      std::string::npos)
      << law::latex(law);
}

// "largest at 0.05 m/s of the velocity …: 0.4 N": the force at 0.05 m/s is 0.4 N; so of every shape
// whose size is told at a place.
TEST(DiscoveredLaw, TheSizeInWordsIsTheForceAtThePlaceThatTheyName) {
  const std::map<std::string, double> told{{"linear", 0.05}, {"power", 0.05}, {"peaked", 0.05},
                                           {"fading", 0.05}, {"log", 0.05},   {"dead_band", 0.1}};
  for (const auto& [shape, speed] : told) {
    const bool with_power = shape == "power";
    Json numbers{{"amplitude_n", -0.8}, {"scale_1_mps", 0.05}};
    if (with_power) numbers["power_1"] = 1.5;
    const EffectSpec effect = discovered(
        (R"({"axis": "base_x", "factors": [{"shape": ")" + shape + R"(", "of": "v_base_x"}]})")
            .c_str(),
        numbers);
    const Wrench wrench =
        applied(effect, moving(Eigen::VectorXd::Constant(3, speed), 0.01), no_wrench(3));
    const std::string words = law::words(law_of(effect));
    EXPECT_NEAR(std::stod(words.substr(words.rfind(": ") + 2)), wrench.force.row(2).norm(), 5e-3)
        << words;
    EXPECT_NE(words.find(" at " + std::string(speed == 0.1 ? "0.1" : "0.05") + " m/s"),
              std::string::npos)
        << words;
  }
}

TEST(DiscoveredLaw, ThePreslidingIsToldWhereItIsComplete) {
  const auto law = law_of(discovered(
      R"({"axis": "base_x", "factors": [{"shape": "linear", "of": "v_base_x", "memory": "dahl"}]})",
      {{"amplitude_n", -0.2}, {"memory_1_m", 0.003}, {"scale_1", 1.0}}));
  EXPECT_EQ(law::words(law),
            "a force against the motion along the base's x axis, proportional to the presliding of "
            "the velocity along the base's x axis over 0.003 m: 0.2 N");
}

TEST(DiscoveredLaw, RefusesUnknownWordsAndUnitsThatItsStructureDoesNotHave) {
  const Json numbers{{"amplitude_n", 1.0}, {"scale_1_mps", 0.1}};
  EXPECT_EQ(refusal_of(R"({"axis": "base_x", "factors": [{"shape": "tanh", "of": "v_base_x"}]})",
                       numbers),
            "");
  EXPECT_NE(
      refusal_of(R"({"axis": "base_x", "factors": [{"shape": "tahn", "of": "v_base_x"}]})", numbers)
          .find("did you mean 'tanh'"),
      std::string::npos);
  EXPECT_NE(refusal_of(R"({"axis": "base_x", "factors": [{"shape": "tanh", "of": "x"}]})", numbers)
                .find("scale_1_m"),
            std::string::npos);
  EXPECT_NE(refusal_of(R"({"axis": "base_x", "factors": []})", {{"amplitude_n", 1.0}}), "");
  EXPECT_NE(refusal_of(R"({"axis": "base_x", "factors": [{"shape": "tanh", "of": "v_base_x"}]})",
                       {{"amplitude_n", 1.0}, {"scale_1_mps", 0.0}}),
            "");
}

TEST(DiscoveredLaw, EveryShapeAndMemoryIsFiniteAndTold) {
  const Motion motion = example_motion(200);
  for (std::size_t shape = 0; shape < law::shapes().size(); ++shape) {
    for (int memory = 0; memory <= static_cast<int>(law::Memory::kUnevenLag); ++memory) {
      law::Factor factor{shape, 5, static_cast<law::Memory>(memory), true};
      if (law::is_curve(shape)) factor.nodes = 5, factor.peak = 2;
      law::Structure structure;
      structure.direction = 2;
      structure.factors = {factor};
      law::Law law{structure, {}};
      const auto list = law::numbers_of(law.structure);
      law.numbers = Eigen::VectorXd::Constant(static_cast<Index>(list.size()), 0.5);
      law::LawRun run(law);
      for (Index k = 0; k < motion.samples(); ++k) {
        const auto force =
            run.step(law::sample_of(motion, k, Eigen::Vector3d::Ones(), {}), 0.002, k == 0);
        ASSERT_TRUE(force.allFinite());
      }
      const Json told = law::to_json(law);
      EXPECT_FALSE(told["words"].get<std::string>().empty());
      EXPECT_EQ(told["latex"].get<std::string>().find_first_of("@#"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace dcnn
