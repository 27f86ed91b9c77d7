// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/tool_model.h"

#include <cmath>

#include "dcnn/core/options.h"
#include "dcnn/data/rotation.h"
#include "physics/simulator_json.h"
#include "physics/vectors.h"

namespace dcnn {
namespace {

// Far beyond any tool, sensor or planet: what is larger is a slip or damage, and would overflow.
constexpr double kMostMass = 1e6;      // kg
constexpr double kMostLength = 1e3;    // m
constexpr double kMostGravity = 1e3;   // m/s²
constexpr double kMostAngle = 1e3;     // rad, of a mounting that was turned several times
constexpr double kMostOffset = 1e9;    // N, N·m
constexpr double kMostInertia = 1e12;  // kg·m²
const Eigen::VectorXd kZero3 = Eigen::VectorXd::Zero(3);

Eigen::Matrix3d symmetric(const Eigen::VectorXd& i) {
  Eigen::Matrix3d I;
  I << i(0), i(3), i(4), i(3), i(1), i(5), i(4), i(5), i(2);
  return I;
}

void read_tool(Options tool, ToolModel& model) {
  tool.get<double>("mass_kg");
  model.mass = tool.number("mass_kg", 0.0, 0.0, kMostMass);
  model.com = read_list(tool, "com_m", kZero3, kMostLength);
  if (tool.has("inertia_kgm2")) {
    model.inertia =
        symmetric(read_list(tool, "inertia_kgm2", Eigen::VectorXd::Zero(6), kMostInertia));
    if ((model.inertia->diagonal().array() < 0.0).any()) {
      tool.reject("inertia_kgm2",
                  "has a negative moment of inertia; its order is ixx,iyy,izz,ixy,ixz,iyz");
    }
  }
  // Keys whose values no recording showed, as dcnn-identify writes them: a note to readers.
  for (const auto& key : tool.get("assumed", std::vector<std::string>{})) {
    if (!tool.has(key)) tool.reject("assumed", "lists '", key, "', which is no key beside it");
  }
  tool.finish();
}

void read_sensor(Options sensor, ToolModel& model) {
  model.bias = read_list(sensor, "bias_n", kZero3, kMostOffset);
  model.bias_torque = read_list(sensor, "bias_nm", kZero3, kMostOffset);
  model.sensor_rotation_rpy = read_list(sensor, "rotation_rpy", kZero3, kMostAngle);
  sensor.finish();
}

const std::vector<std::string> kInertialWords{"full", "linear", "none"};

ToolModel::Inertial read_inertial(Options options) {
  const auto word = options.choice("inertial", "full", kInertialWords);
  options.finish();
  if (word == "linear") return ToolModel::Inertial::kLinear;
  return word == "none" ? ToolModel::Inertial::kNone : ToolModel::Inertial::kFull;
}

}  // namespace

Eigen::Matrix3d ToolModel::R_ES() const {
  return rotation_from_euler(sensor_rotation_rpy.reverse());
}

ToolModel read_tool_model(Options& options) {
  ToolModel model;
  if (!options.has("tool")) options.reject("tool", "is missing; it holds at least mass_kg");
  read_tool(options.child("tool"), model);
  model.gravity = read_list(options, "gravity_mps2", model.gravity, kMostGravity);
  read_sensor(options.child("sensor"), model);
  model.inertial = read_inertial(options.child("model"));
  model.sample_rate_hz = options.number("sample_rate_hz", model.sample_rate_hz, 1e-3, 1e6);
  return model;
}

ToolModel parse_tool_model(const Json& json, const std::string& where, Exit exit) {
  Options options(json, where, exit);
  ToolModel model = read_tool_model(options);
  options.finish();
  return model;
}

Json to_json(const ToolModel& model) {
  Json tool{{"mass_kg", model.mass}, {"com_m", to_list(model.com)}};
  if (model.inertia) {
    const Eigen::Matrix3d& I = *model.inertia;
    tool["inertia_kgm2"] = {I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)};
  }
  Json sensor{{"bias_n", to_list(model.bias)},
              {"rotation_rpy", to_list(model.sensor_rotation_rpy)}};
  if (!model.bias_torque.isZero(0.0)) sensor["bias_nm"] = to_list(model.bias_torque);
  return {{"tool", tool},
          {"gravity_mps2", to_list(model.gravity)},
          {"sensor", sensor},
          {"model", {{"inertial", kInertialWords[static_cast<std::size_t>(model.inertial)]}}},
          {"sample_rate_hz", model.sample_rate_hz}};
}

}  // namespace dcnn
