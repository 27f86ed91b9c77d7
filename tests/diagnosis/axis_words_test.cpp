// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/axis_words.h"

#include <gtest/gtest.h>

namespace dcnn {
namespace {

Json number(double value, double half, const char* unit) {
  return {{"value", value}, {"ci95", {value - half, value + half}}, {"unit", unit}};
}

Axis axis_in(const char* unit) {
  Axis axis;
  axis.name = "elbow";
  axis.position_unit = unit;
  return axis;
}

std::string words(const char* effect, const Json& parameters, const char* unit = "rad") {
  return axis_words({{"effect", effect}, {"parameters", parameters}}, axis_in(unit), "");
}

TEST(AxisWords, AForceThatRepeatsIsToldByItsOrder) {
  const Json force{{"amp", number(4.2, 0.5, "N*m")}, {"order", number(0.9, 0.05, "")}};
  EXPECT_EQ(words("cogging", force), "cogging of 4.2 N·m that repeats with order 0.9 on elbow");
}

TEST(AxisWords, AWeightIsToldByWhatItMakesAtMost) {
  const Json weight{{"amp", number(4.2, 0.5, "N*m")}, {"rest", number(0.1, 0.05, "rad")}};
  EXPECT_EQ(words("gravity_load", weight),
            "a load off its axis, whose weight makes up to 4.2 N·m on elbow");
}

TEST(AxisWords, HysteresisIsSaidByTheForceAtWhichItSettles) {
  const auto law = [](double gamma) {
    return Json{{"force", number(0.005, 0.001, "N*m")},
                {"width", number(0.01, 0.001, "rad")},
                {"beta", number(1.0, 0.0, "")},
                {"gamma", number(gamma, 0.01, "")},
                {"m", number(1.0, 0.0, "")}};
  };
  EXPECT_EQ(words("hysteresis", law(-0.9)), "hysteresis of 0.05 N·m on elbow");
  EXPECT_EQ(words("hysteresis", law(-1.3)),
            "hysteresis that grows by 0.5 N·m/rad after a turn back on elbow");
}

}  // namespace
}  // namespace dcnn
