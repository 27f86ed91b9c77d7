// Limits and reports for tests of designs.
#pragma once

#include "dcnn/design/limits.h"

namespace dcnn::test {

/// A tool that may move 0.12 m and 0.9 rad to every side.
inline Json tool_limits_json() {
  return {{"rate_hz", 500},
          {"position_m", {{"x", {-0.12, 0.12}}, {"y", {-0.12, 0.12}}, {"z", {-0.12, 0.12}}}},
          {"angle_rad", {{"alpha", {-0.9, 0.9}}, {"beta", {-0.7, 0.7}}, {"gamma", {2.3, 3.98}}}},
          {"speed_mps", 0.4},
          {"acceleration_mps2", 2.0},
          {"jerk_mps3", 30.0},
          {"rate_radps", 1.5},
          {"acceleration_radps2", 8.0},
          {"jerk_radps3", 120.0},
          {"start", {{"position_m", {0, 0, 0}}, {"angle_rad", {0, 0, 3.1}}}}};
}
inline design::Limits tool_limits() { return design::parse_limits(tool_limits_json(), "limits.json", "."); }

}  // namespace dcnn::test
