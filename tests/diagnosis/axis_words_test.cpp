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

TEST(AxisWords, AForceOfTheSineOfATurnIsTheOneOfAWeight) {
  const auto force = [](double order, double half) {
    return Json{{"amp", number(4.2, 0.5, "N*m")}, {"order", number(order, half, "")}};
  };
  EXPECT_NE(words("cogging", force(0.99, 0.05)).find("4.2 N·m"), std::string::npos);
  EXPECT_NE(words("cogging", force(0.99, 0.05)).find("weight"), std::string::npos);
  EXPECT_EQ(words("cogging", force(0.9, 0.05)),
            "cogging of 4.2 N·m that repeats with order 0.9 on elbow");
  EXPECT_EQ(words("cogging", force(0.99, 0.05), "m").find("weight"), std::string::npos);
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
