// SPDX-License-Identifier: Apache-2.0
// Small identification problems with a known answer for the tests of the models room.
#pragma once

#include <string>

#include "dcnn/models/model.h"
#include "dcnn/physics/simulator.h"
#include "dcnn/physics/trajectory.h"

namespace dcnn::test {

/// A swinging tool with mounting, bias and inertia.
inline ToolModel swinging_tool() {
  ToolModel tool;
  tool.mass = 0.75;
  tool.com = {0.01, -0.02, 0.16};
  const Eigen::Matrix3d about_com = Eigen::Vector3d(0.0015, 0.0014, 0.0005).asDiagonal();
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  tool.inertia =
      about_com + tool.mass * (tool.com.squaredNorm() * one - tool.com * tool.com.transpose());
  tool.sensor_rotation_rpy = {0.1, -0.2, 0.3};
  tool.bias = {0.6, -0.4, 1.1};
  tool.bias_torque = {0.02, 0.01, -0.03};
  return tool;
}

/// Rows without numerical differentiation: pose, exact rates and wrench as they would be logged.
/// `kind` multisine or static.
inline Recording exact_recording(const ToolModel& tool, const std::string& kind, Index rows,
                                 std::uint64_t seed) {
  Json json = {{"kind", kind}, {"angle_rad", {0.9, 0.6, 0.7}}, {"angle_center_rad", {0.2, 0, 1.0}}};
  const bool moves = kind != "static";
  if (moves) {
    json.update({{"tones", 4}, {"hz", {0.3, 2.0}}, {"position_m", {0.1, 0.08, 0.12}}});
  }
  Rng rng(seed);
  const Trajectory trajectory =
      make_trajectory(Options(json, "test", Exit::kUsage), {rows, 0.002, 0.0}, rng);
  const Motion motion = motion_of(trajectory, tool);
  Recording recording;
  recording.name = "exact.csv";
  recording.dt = motion.dt;
  recording.segments = motion.segments;
  recording.table.values.resize(rows, 0);
  const auto set = [&](const std::vector<std::string>& names, const Eigen::MatrixXd& values) {
    for (Index k = 0; k < 3; ++k) {
      recording.set(names[static_cast<std::size_t>(k)], values.col(k));
    }
  };
  set({"alpha", "beta", "gamma"}, trajectory.euler);
  if (moves) {
    recording.set("t", motion.t);
    set({"x", "y", "z"}, trajectory.position);
    Eigen::MatrixXd v(rows, 3), a(rows, 3);
    for (Index i = 0; i < rows; ++i) {
      const Eigen::Matrix3d R_SB = motion.R_BS[static_cast<std::size_t>(i)].transpose();
      v.row(i) = (R_SB * motion.v_B.row(i).transpose()).transpose();
      a.row(i) = (R_SB * motion.a_B.row(i).transpose()).transpose();
    }
    set({"vx", "vy", "vz"}, v);
    set({"ax", "ay", "az"}, a);
    set({"wx", "wy", "wz"}, motion.w_S);
    set({"dwx", "dwy", "dwz"}, motion.dw_S);
  }
  set_wrench(simulate({tool, {}}, motion), "", recording);
  return recording;
}

/// What a kind is asked to learn from a recording, and its samples.
struct Task {
  Problem problem;
  Samples samples;
};

inline Samples samples_of(const Recording& recording, const Problem& problem) {
  Samples samples;
  samples.x = make_features(recording, problem.layout).x;
  samples.y = recording.block(problem.targets.names);
  samples.segments = recording.segments;
  return samples;
}

/// `set` pose or body, its frame the tool's mounting; the configuration is laid on the quick preset
/// of `kind` with clean training.
inline Task task_of(const std::string& kind, const Recording& recording, const std::string& set,
                    const Json& configuration = Json::object(), bool torques = false) {
  Task task;
  const Eigen::Vector3d rpy = swinging_tool().sensor_rotation_rpy;
  const Json features = {{"set", set}, {"sensor_rotation_rpy", {rpy[0], rpy[1], rpy[2]}}};
  task.problem.layout =
      make_layout({recording}, parse_features(Options(features, "test", Exit::kUsage), {}), {});
  task.problem.targets = {{"fx", "fy", "fz"}, {"N", "N", "N"}};
  if (torques) {
    task.problem.targets = {{"fx", "fy", "fz", "tx", "ty", "tz"},
                            {"N", "N", "N", "N*m", "N*m", "N*m"}};
  }
  Json& json = task.problem.configuration;
  json = model_kind(kind, Exit::kUsage).preset("quick", false);
  json["noise"] = {{"levels_db", Json::array({nullptr})}};
  for (const auto& [section, keys] : configuration.items()) json[section].update(keys);
  task.problem.where = "test";
  task.problem.seed = 1;
  task.samples = samples_of(recording, task.problem);
  return task;
}

inline std::unique_ptr<Model> fitted(const std::string& kind, const Task& task) {
  auto model = model_kind(kind, Exit::kUsage).make(task.problem);
  FitSession session;
  model->fit(task.samples, {}, session);
  return model;
}

inline Container saved(const Model& model) {
  Container file;
  model.save(file);
  return file;
}

}  // namespace dcnn::test
