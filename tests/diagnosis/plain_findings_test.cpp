// SPDX-License-Identifier: Apache-2.0
// What a reader is told of several findings along one axis, and of numbers that mean nothing.
#include "diagnosis/plain_findings.h"

#include <gtest/gtest.h>

#include "dcnn/diagnosis/diagnose.h"

namespace dcnn {
namespace {

Json said(double value, const char* unit, double spread = 0.1) {
  return {{"value", value},
          {"ci95", {value - spread * std::abs(value), value + spread * std::abs(value)}},
          {"unit", unit}};
}

Json said_finding(const char* effect, const Json& axis, const Json& parameters,
                  const char* words = "a law on joint2") {
  return {
      {"effect", effect},  {"axis", axis},        {"parameters", parameters},     {"words", words},
      {"confidence", 0.9}, {"holdout_gain", 0.3}, {"alternatives", Json::array()}};
}

TEST(PlainFindings, TheFrictionOfAnAxisIsOneCurve) {
  Json lugre = said_finding("lugre_friction", "joint2",
                            {{"fc", said(4.0, "N*m")}, {"sigma0", said(1000.0, "N*m/rad")}},
                            "friction of 4 N*m that first gives way elastically on joint2");
  lugre["alternatives"] = {"coulomb_friction", "hysteresis"};
  lugre["confidence"] = 0.3;
  Json viscous = said_finding("viscous_friction", "joint2", {{"c", said(30.0, "N*m*s/rad")}});
  viscous["confidence"] = 0.95;
  const Json findings{lugre, viscous,
                      said_finding("cable_spring", "joint2",
                                   {{"k", said(2.0, "N*m/rad")}, {"rest", said(0.1, "rad")}}),
                      said_finding("coulomb_friction", "joint2", {{"fc", said(8.0, "N*m")}})};
  const Json lines = in_lines(findings);
  ASSERT_EQ(lines.size(), 2U) << lines.dump(1);
  EXPECT_EQ(lines[0]["effect"], "friction");
  EXPECT_EQ(lines[0]["words"],
            "friction: 12 N·m dry, 30 N·m·s/rad viscous, 4 mrad of presliding on joint2");
  EXPECT_EQ(lines[0]["alternatives"], Json::array({"hysteresis"}));
  EXPECT_EQ(lines[0]["confidence"], 0.95);  // as the most probable of its forms
  EXPECT_EQ(lines[1]["effect"], "cable_spring");
}

TEST(PlainFindings, ANumberThatSpansDecadesIsNotTold) {
  EXPECT_TRUE(is_told(said(4.0, "N*m", 0.5)));
  EXPECT_TRUE(is_told(said(4.0, "N*m", 2.0)));  // through zero: of either sign
  EXPECT_FALSE(is_told({{"value", 1e5}, {"ci95", {300.0, 5e7}}, {"unit", "N*m/rad"}}));
  EXPECT_TRUE(is_told({{"value", 1e5}, {"ci95", {nullptr, nullptr}}, {"unit", "N*m/rad"}}));
}

TEST(PlainFindings, FrictionsOfTwoAxesStayTwo) {
  const Json findings{said_finding("coulomb_friction", "joint1", {{"fc", said(8.0, "N*m")}}),
                      said_finding("viscous_friction", "joint2", {{"c", said(3.0, "N*m*s/rad")}})};
  EXPECT_EQ(in_lines(findings), findings);
}

TEST(PlainFindings, EveryPartOfTheCurveHasItsWords) {
  EXPECT_EQ(
      friction_words(
          {said_finding("stribeck_friction", "a", {{"fc", said(3.0, "N")}, {"fs", said(5.0, "N")}}),
           said_finding("viscous_friction", "a", {{"c", said(10.0, "N*s/m")}}),
           said_finding("asymmetric_friction", "a", {{"delta_c", said(2.0, "N*s/m")}}),
           said_finding("load_friction", "a", {{"mu", said(0.05, "")}})}),
      "friction: 3 N dry (5 N at rest), 12 N·s/m viscous forwards and 8 backwards, 5 % of the "
      "load");
  EXPECT_EQ(friction_words(
                {said_finding(
                     "gear_friction", "a",
                     {{"fc", said(2.0, "N*m")}, {"a", said(0.25, "")}, {"order", said(8.0, "")}}),
                 said_finding("quadratic_drag", "a", {{"c2", said(0.5, "N*m*s^2/rad^2")}})}),
            "friction: 2 N·m dry, varying by 25 % with order 8 of the position, 0.5 N·m·s²/rad² "
            "of drag");
}

TEST(PlainFindings, FrictionOfAToolKeepsItsPlace) {
  const Json lines =
      in_lines({said_finding("coulomb_friction", "tool_z", {{"fc_n", said(0.4, "N")}},
                             "dry friction of 0.4 N along the tool"),
                said_finding("lugre_friction", "tool_z",
                             {{"fc_n", said(0.2, "N")}, {"sigma0_npm", said(100.0, "N/m")}})});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0]["words"], "friction: 0.6 N dry, 2 mm of presliding along the tool");
}

TEST(PlainFindings, APreslidingThatNobodyKnowsIsNotTold) {
  Json lugre = said_finding("lugre_friction", "a",
                            {{"fc", said(4.0, "N")}, {"sigma0", said(1000.0, "N/m")}});
  EXPECT_EQ(friction_words(Json::array({lugre})), "friction: 4 N dry, 4 mm of presliding");
  lugre["parameters"]["sigma0"]["ci95"] = {30.0, 30000.0};
  EXPECT_EQ(friction_words(Json::array({lugre})), "friction: 4 N dry");
}

TEST(PlainFindings, ASpringWhoseRestIsTurnsAwayIsAConstant) {
  const auto spring = [](const Json& k, const Json& rest, const Json& axis = "joint2") {
    return said_finding("cable_spring", axis, {{"k", k}, {"rest", rest}});
  };
  EXPECT_FALSE(is_constant(spring(said(2.0, "N*m/rad"), said(1.0, "rad"))));
  const Json far = spring(said(1e-6, "N*m/rad"), said(3e6, "rad"));
  EXPECT_TRUE(is_constant(far));
  EXPECT_EQ(constant_words(far), "a constant of 3 N·m");
  EXPECT_TRUE(is_constant(spring(said(0.1, "N*m/rad", 2.0), said(1.0, "rad"))));
  const Json lines = in_lines(Json::array({far}));
  EXPECT_EQ(lines[0]["effect"], "constant_force");
  EXPECT_EQ(lines[0]["parameters"].size(), 1U);
  const Json k = said(1e-6, "N/rad"), rest = said(3e6, "rad");
  EXPECT_EQ(constant_words(spring(k, rest, "alpha:base_x")),
            "a constant of 3 N along the base's x axis, as a tilt of gravity makes");
  EXPECT_EQ(constant_words(spring(k, rest, "beta:base_z")),
            "a constant of 3 N along the base's z axis, as a weight makes");
  EXPECT_EQ(constant_words(spring(k, rest, "alpha:sensor_y")),
            "a constant of 3 N along the sensor's y axis, as an offset of the sensor makes");
}

}  // namespace
}  // namespace dcnn
