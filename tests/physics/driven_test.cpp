// SPDX-License-Identifier: Apache-2.0
// Laws whose strength follows a logged signal, against their closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/physics/axis_machine.h"
#include "dcnn/physics/streaming_simulator.h"
#include "physics/support.h"

namespace dcnn {
namespace {

Json driven_viscous(double lag) {
  return {{"c_nspm", 2.0}, {"driven_by", "pressure"}, {"slope", 0.5}, {"lag_s", lag}};
}

/// At 1 m/s along x, beside a pressure of p(t).
template <class Pressure>
Motion beside(const Pressure& p) {
  Motion motion = still_motion(200);
  motion.v_B.col(0).setOnes();
  motion.signals.push_back({"pressure", motion.t.unaryExpr(p)});
  return motion;
}

TEST(DrivenLaw, StrengthIsAPlusSlopeTimesTheSignalSomeTimeBefore) {
  const auto pressure = [](double t) { return 3.0 + std::sin(9.0 * t); };
  const Motion motion = beside(pressure);
  for (const double lag : {0.0, 0.05, -0.05}) {
    const auto effect = make_effect("viscous_friction", "base_x", driven_viscous(lag));
    const Eigen::MatrixXd force = applied(effect, motion, no_wrench(200)).force;
    for (Index k = 30; k < 170; ++k) {
      EXPECT_NEAR(force(k, 0), -(2.0 + 0.5 * pressure(motion.t(k) - lag)), 1e-6) << lag;
    }
    EXPECT_EQ(force.rightCols(2).norm(), 0.0);
  }
}

TEST(DrivenLaw, OfNoStrengthAtZeroOfTheSignalFollowsItAlone) {
  Motion motion = still_motion(2);
  motion.euler.col(0) << 0.3, -0.1;
  motion.signals.push_back({"pressure", Eigen::Vector2d(2.0, 4.0)});
  const auto effect = make_effect("cable_spring", "alpha:sensor_y",
                                  {{"k_nprad", 0.0},
                                   {"rest_rad", 0.1},
                                   {"driven_by", "pressure"},
                                   {"slope", 1.5},
                                   {"lag_s", 0.0}});
  const Eigen::MatrixXd force = applied(effect, motion, no_wrench(2)).force;
  EXPECT_NEAR(force(0, 1), -3.0 * 0.2, 1e-12);
  EXPECT_NEAR(force(1, 1), 6.0 * 0.2, 1e-12);
}

TEST(DrivenLaw, NeedsItsSignalAndALawOfOneStrength) {
  const auto effect = make_effect("viscous_friction", "base_x", driven_viscous(0.0));
  EXPECT_THROW(applied(effect, still_motion(5), no_wrench(5)), Error);
  EXPECT_THROW(
      make_effect(
          "mass", "",
          {{"delta_mass_kg", 0.1}, {"driven_by", "pressure"}, {"slope", 1.0}, {"lag_s", 0.0}}),
      Error);
}

TEST(DrivenLaw, IsLeftOutOnline) {
  const auto effect = make_effect("viscous_friction", "base_x", driven_viscous(0.0));
  EXPECT_FALSE(runs_online(effect));
  std::vector<std::string> left_out;
  online_part({example_tool(), {effect}}, left_out);
  EXPECT_EQ(left_out, std::vector<std::string>{"viscous_friction"});
}

TEST(DrivenLaw, OfAnAxisIsReadAndWrittenInItsTerms) {
  const Json model{
      {"system",
       {{"kind", "axes"},
        {"axes",
         {{{"name", "joint"},
           {"measured", "torque"},
           {"unit", "N*m"},
           {"position", "q"},
           {"velocity", "qd"},
           {"base", Json::array()},
           {"signals", {"temp"}}}}}}},
      {"axes",
       {{{"axis", "joint"},
         {"effects",
          {{{"effect", "viscous_friction"},
            {"interval_s", nullptr},
            {"parameters",
             {{"c", 1.0}, {"driven_by", "temp"}, {"slope", 0.25}, {"lag", 0.0}}}}}}}}}};
  const AxisMachine machine = parse_axis_machine(model, "test", Exit::kData);
  Recording log;
  log.dt = 0.01;
  constexpr Index kLogged = 40;
  log.segments = {{0, kLogged}};
  const Eigen::VectorXd row = Eigen::VectorXd::LinSpaced(kLogged, 0.0, 39.0);
  const Eigen::VectorXd rate = row.array().sin(), temperature = 20.0 + row.array();
  log.set("t", 0.01 * row);
  log.set("q", Eigen::VectorXd::Zero(kLogged));
  log.set("qd", rate);
  log.set("temp", temperature);
  const Eigen::VectorXd torque = predict_axes(machine, log).col(0);
  const Eigen::VectorXd expected = (1.0 + 0.25 * temperature.array()) * rate.array();
  EXPECT_LT((torque - expected).cwiseAbs().maxCoeff(), 1e-12);
  const Json again = to_json(machine)["axes"][0]["effects"][0]["parameters"];
  EXPECT_EQ(again["driven_by"], "temp");
  EXPECT_EQ(again["c"], 1.0);
  EXPECT_EQ(again["slope"], 0.25);
}

}  // namespace
}  // namespace dcnn
