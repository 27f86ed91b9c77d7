// SPDX-License-Identifier: Apache-2.0
// Recordings of a swinging tool for the tests of the physics room.
#pragma once

#include <sstream>
#include <string>

#include "dcnn/physics/simulator.h"
#include "dcnn/physics/trajectory.h"

namespace dcnn {

inline Json example_trajectory() {
  return {{"kind", "multisine"},
          {"tones", 4},
          {"hz", {0.3, 2.0}},
          {"position_m", {0.1, 0.08, 0.12}},
          {"angle_rad", {0.9, 0.6, 0.7}},
          {"angle_center_rad", {0.2, 0.0, 1.0}}};
}

inline ToolModel example_tool() {
  ToolModel tool;
  tool.mass = 0.75;
  tool.com = {0.01, -0.02, 0.16};
  tool.inertia = Eigen::Vector3d(0.021, 0.02, 0.004).asDiagonal();
  tool.sensor_rotation_rpy = {0.1, -0.2, 0.3};
  tool.bias = {0.6, -0.4, 1.1};
  return tool;
}

inline Motion example_motion(Index samples = 2000, const ToolModel& tool = example_tool()) {
  Rng rng(5);
  return motion_of(make_trajectory(Options(example_trajectory(), "test", Exit::kUsage),
                                   {samples, 0.002, 0.0}, rng),
                   tool);
}

/// T samples at 500 Hz without any motion, S = B; tests then write the signals that they need.
inline Motion still_motion(Index samples, double dt = 0.002) {
  Motion motion;
  motion.dt = dt;
  motion.t = Eigen::VectorXd::LinSpaced(samples, 0.0, dt * static_cast<double>(samples - 1));
  motion.R_BS.assign(static_cast<std::size_t>(samples), Eigen::Matrix3d::Identity());
  motion.p_B = motion.euler = motion.v_B = motion.a_B = motion.w_S = motion.dw_S =
      Eigen::MatrixXd::Zero(samples, 3);
  motion.segments = {{0, samples}};
  return motion;
}

inline Wrench no_wrench(Index samples) {
  return {Eigen::MatrixXd::Zero(samples, 3), Eigen::MatrixXd::Zero(samples, 3)};
}

/// One effect, checked as a configuration would be.
inline EffectSpec make_effect(const std::string& effect, const std::string& axis,
                              const Json& parameters, const Json& interval = nullptr,
                              const char* law = nullptr) {
  Json entry{{"effect", effect}, {"axis", nullptr}, {"interval_s", interval}};
  if (!axis.empty()) entry["axis"] = axis;
  entry["parameters"] = parameters;
  if (law) entry["law"] = Json::parse(law);
  return parse_effects(Json::array({entry}), "test", Exit::kUsage).front();
}

/// The effect with the parameters of its example, on the last axis that it admits.
inline EffectSpec example_effect(const EffectKind& kind) {
  const auto axes = admitted_axes(kind.axis);
  const bool interval =
      kind.interval == IntervalRule::kRequired || kind.interval == IntervalRule::kOnset;
  return make_effect(kind.name, axes.empty() ? "" : axes.front(), Json::parse(kind.example),
                     interval ? Json{0.5, 1.5} : Json(), kind.example_law);
}

/// What the effect does to a given wrench.
inline Wrench applied(const EffectSpec& effect, const Motion& motion, Wrench wrench,
                      const ToolModel& model = example_tool()) {
  apply_effect(effect, motion, model, wrench);
  return wrench;
}

/// The value that a JSON pointer such as "/effects/0/axis" leads to.
inline Json& at_pointer(Json& json, const std::string& pointer) {
  Json* place = &json;
  std::istringstream keys(pointer.substr(1));
  for (std::string key; std::getline(keys, key, '/');) {
    place = place->is_array() ? &place->at(std::stoul(key)) : &(*place)[key];
  }
  return *place;
}

/// A file of this repository as JSON.
inline Json repository_json(const std::string& path) {
  return read_json(std::string(DCNN_SOURCE_DIR "/") + path, Exit::kData);
}

}  // namespace dcnn
