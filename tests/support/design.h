// SPDX-License-Identifier: Apache-2.0
// Limits and reports for tests of designs.
#pragma once

#include "dcnn/design/design.h"
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
inline design::Limits tool_limits() {
  return design::parse_limits(tool_limits_json(), "limits.json", ".");
}

inline Json effect_json(const char* effect, const char* axis, const Json& parameters) {
  return {{"effect", effect}, {"axis", axis}, {"interval_s", nullptr}, {"parameters", parameters}};
}

/// A report that leaves dry and viscous friction along the tool open, as likely as each other, and
/// its model.json.
inline design::DesignRequest friction_request() {
  const Json dry = effect_json("coulomb_friction", "tool_z", {{"fc_n", 0.05}, {"v0_mps", 0.01}});
  const Json viscous = effect_json("viscous_friction", "tool_z", {{"c_nspm", 0.4}});
  design::DesignRequest request;
  request.where = "report.json";
  request.report = {
      {"targets", {"fx", "fy", "fz"}},
      {"fit", {{"noise_floor", {0.2, 0.2, 0.2}}}},
      {"posterior",
       {{"nothing", 0.01}, {"named", 0.96}, {"named_and_unknown", 0.02}, {"unknown", 0.01}}},
      {"rivals", Json::array({Json{{"effects", Json::array({viscous})},
                                   {"log_odds", 0.0},
                                   {"chi2_above", 0.0},
                                   {"more_numbers", -1}}})}};
  request.model = {{"tool", {{"mass_kg", 0.6}, {"com_m", {0.0, 0.01, 0.1}}}},
                   {"effects", Json::array({dry})}};
  request.limits = tool_limits();
  request.seconds = 10.0;
  request.evaluations = 30;
  return request;
}

}  // namespace dcnn::test
