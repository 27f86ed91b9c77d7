// SPDX-License-Identifier: Apache-2.0
// The generator's laws of hardware against those of the catalogue: two codes, two integrators, one
// law.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "conceal/draws.h"
#include "conceal/laws.h"
#include "conceal/world.h"
#include "dcnn/conceal/challenge.h"
#include "dcnn/physics/axis_machine.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

double position(double t) { return 0.3 * std::sin(2.1 * t) + 0.1 * std::sin(5.3 * t + 1.0); }

/// An axis along base x, its position as alpha too, 4 s long; it transmits `load`.
Path axis_path(const MatrixXd& load = MatrixXd(0, 3)) {
  constexpr Index kSamples = 16000;
  MatrixXd pose = MatrixXd::Zero(kSamples, 6);
  for (Index i = 0; i < kSamples; ++i) pose(i, 0) = pose(i, 3) = position(kStep * double(i));
  Path path = follow(0.0, pose, std::vector<Eigen::Matrix3d>(kSamples, Eigen::Matrix3d::Identity()),
                     Vector3d::Zero());
  path.load = load;
  return path;
}

/// The same motion at every eighth sample, as the catalogue sees it.
Motion axis_motion_of(const Path& path) {
  Motion motion;
  const Index n = path.samples() / 8;
  motion.dt = 8.0 * kStep;
  motion.t = VectorXd::LinSpaced(n, 0.0, motion.dt * double(n - 1));
  motion.R_BS.assign(static_cast<std::size_t>(n), Eigen::Matrix3d::Identity());
  motion.euler = motion.v_B = motion.a_B = motion.w_S = motion.dw_S = MatrixXd::Zero(n, 3);
  for (Index k = 0; k < n; ++k) {
    motion.euler(k, 0) = path.pose(8 * k, 3);
    motion.v_B(k, 0) = path.velocity(8 * k, 0);
  }
  motion.segments = {{0, n}};
  return motion;
}

Hidden hidden_law(const std::string& id, const std::string& axis,
                  const std::map<std::string, double>& parameters) {
  Hidden h;
  h.effect = id;
  h.axis = axis;
  h.parameters = parameters;
  return h;
}

VectorXd thinned_x(const MatrixXd& F) { return F(Eigen::seqN(0, F.rows() / 8, 8), 0); }

VectorXd of_generator(const Path& path, const Hidden& h) {
  const MatrixXd field = MatrixXd::Zero(path.samples(), 3);
  MatrixXd F = field;
  add_force(path, h, field, path.load.rows() > 0 ? path.load : field, F);
  return thinned_x(F);
}

VectorXd of_catalogue(const Path& path, const Hidden& h) {
  Motion motion = axis_motion_of(path);
  motion.of_axis = path.load.rows() > 0;
  Json parameters = Json::object();
  for (const auto& [name, value] : h.parameters) parameters[name] = value;
  Wrench wrench{MatrixXd::Zero(motion.samples(), 3), MatrixXd(0, 3)};
  if (path.load.rows() > 0)
    wrench.load = path.load(Eigen::seqN(0, motion.samples(), 8), Eigen::all);
  apply_effect({h.effect, h.axis, std::nullopt, parameters, ""}, motion, ToolModel(), wrench);
  return wrench.force.col(0);
}

void expect_same_law(const Path& path, const Hidden& h, double tolerance) {
  const VectorXd ours = of_catalogue(path, h), theirs = of_generator(path, h);
  EXPECT_GT(ours.cwiseAbs().maxCoeff(), 0.05) << h.effect;
  EXPECT_LT((ours - theirs).cwiseAbs().maxCoeff(), tolerance) << h.effect;
}

TEST(HardwareTwins, AreTheLawsOfTheCatalogue) {
  const Path path = axis_path();
  expect_same_law(
      path,
      hidden_law("gear_friction", "alpha:base_x",
                 {{"fc_n", 0.5}, {"a", 0.4}, {"order", 7.0}, {"phase_rad", 0.3}, {"v0_mps", 0.02}}),
      1e-9);
  expect_same_law(
      path, hidden_law("quadratic_spring", "alpha:base_x", {{"k2_nprad2", 2.0}, {"rest_rad", 0.1}}),
      1e-9);
  expect_same_law(path, hidden_law("asymmetric_friction", "base_x", {{"delta_c_nspm", 0.5}}), 1e-9);
}

TEST(HardwareTwins, HysteresisOfEitherSignAndAnyExponent) {
  const Path path = axis_path();
  for (const auto& [beta, gamma, m] :
       {std::array{1.0, -1.4, 1.0}, {0.8, -0.3, 1.0}, {0.6, -0.8, 1.5}, {0.6, 0.4, 2.0}}) {
    expect_same_law(
        path,
        hidden_law(
            "hysteresis", "alpha:base_x",
            {{"force_n", 1.0}, {"width_rad", 0.3}, {"beta", beta}, {"gamma", gamma}, {"m", m}}),
        2e-3);
  }
}

TEST(HardwareTwins, LoadFrictionOfAnAxisAndOfATool) {
  MatrixXd load(16000, 3);
  for (Index i = 0; i < load.rows(); ++i) {
    const double t = kStep * double(i);
    load.row(i) << 8.0 * std::sin(t), 0.0, 0.0;
  }
  const Hidden h = hidden_law("load_friction", "base_x", {{"mu", 0.1}, {"v0_mps", 0.02}});
  expect_same_law(axis_path(load), h, 1e-9);

  // A tool: its weight hangs across the way.
  const Path path = axis_path();
  Tool tool;
  tool.mass = 2.0;
  tool.inertial = "linear";
  const MatrixXd change = force(path, tool, {h}) - force(path, tool, {});
  const Index i = 5000;
  const double v = path.velocity(i, 0);
  EXPECT_NEAR(change(i, 0), -0.1 * 2.0 * 9.81 * std::tanh(v / 0.02), 1e-6);
}

TEST(HardwareTwins, CreepSettlesAsTheCatalogueSays) {
  const Path path = axis_path();
  MatrixXd F(path.samples(), 3);
  for (Index i = 0; i < F.rows(); ++i) {
    const double t = kStep * double(i);
    F.row(i) << 5.0 + 3.0 * std::sin(2.0 * t), -2.0, t < 2.0 ? 1.0 : 4.0;
  }
  MatrixXd theirs = F;
  change_reading(path, hidden_law("creep", "", {{"a", 0.2}, {"tau_s", 0.7}}), theirs);
  const Motion motion = axis_motion_of(path);
  const auto thin = Eigen::seqN(0, motion.samples(), 8);
  Wrench ours{F(thin, Eigen::all), MatrixXd(0, 3)};
  apply_effect({"creep", "", std::nullopt, Json{{"a", 0.2}, {"tau_s", 0.7}}, ""}, motion,
               ToolModel(), ours);
  EXPECT_LT((ours.force - theirs(thin, Eigen::all)).cwiseAbs().maxCoeff(), 2e-3);
}

TEST(HardwareTwins, AStrengthFollowsTheTemperatureAsTheCatalogueSays) {
  Path path = axis_path();
  Rng rng({7});
  path.climate = draw_climate(rng);
  Hidden h = hidden_law("viscous_friction", "base_x", {{"c_nspm", -20.0}, {"slope", 1.5}});
  MatrixXd theirs = MatrixXd::Zero(path.samples(), 3);
  add_force(path, h, theirs, theirs, theirs);
  Motion motion = axis_motion_of(path);
  VectorXd temperature(motion.samples());
  for (Index k = 0; k < temperature.size(); ++k) temperature(k) = path.climate(path.time(8 * k));
  motion.signals.push_back({"temperature", temperature});
  Wrench ours{MatrixXd::Zero(motion.samples(), 3), MatrixXd(0, 3)};
  const Json parameters{
      {"c_nspm", -20.0}, {"driven_by", "temperature"}, {"slope", 1.5}, {"lag_s", 0.0}};
  apply_effect({"viscous_friction", "base_x", std::nullopt, parameters, ""}, motion, ToolModel(),
               ours);
  EXPECT_GT(ours.force.col(0).cwiseAbs().maxCoeff(), 1.0);
  EXPECT_LT((ours.force.col(0) - thinned_x(theirs).head(motion.samples())).cwiseAbs().maxCoeff(),
            1e-9);
}

TEST(HardwareFamily, DrawsItsLawsWhereAnotherHasListedOnes) {
  const auto ids = in_family(plan(60, 5), "hardware");
  std::set<std::string> seen;
  for (const auto& id : ids) {
    EXPECT_EQ(id.rfind("hardware+", 0), 0U) << id;
    if (id.find("+single:") == id.npos) continue;
    seen.insert(id.substr(id.find('/') + 1, id.rfind('/') - id.find('/') - 1));
  }
  EXPECT_EQ(seen, std::set<std::string>(hardware_effects().begin(), hardware_effects().end()));
}

TEST(HardwareFamily, ADrawnLawHasTheAmplitudeAskedFor) {
  for (const auto& effect : hardware_effects()) {
    const Scenario s = draw("hardware+single:0.5/" + effect + "/1", 3);
    ASSERT_EQ(s.hidden.size(), 1U);
    EXPECT_EQ(s.hidden[0].effect, undriven(effect));
    EXPECT_EQ(truth(s)["hidden"][0].contains("driven_by"), effect != undriven(effect));
    EXPECT_NEAR(s.hidden[0].amplitude, 0.5, 0.05);
    EXPECT_EQ(truth(s)["hidden"][0]["listed"], true);
  }
}

}  // namespace
}  // namespace dcnn::conceal
