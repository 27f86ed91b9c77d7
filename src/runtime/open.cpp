// SPDX-License-Identifier: Apache-2.0
#include "dcnn/runtime/open.h"

#include "dcnn/calibration/calibration.h"

namespace dcnn {
namespace {

using Note = std::function<void(const std::string&)>;

Eigen::Matrix3d mounting_of(const FeatureLayout& layout) {
  ToolModel model;
  model.sensor_rotation_rpy = layout.spec.sensor_rotation_rpy;
  return model.R_ES();
}

/// Without what the bias tracker follows instead, where there is one.
Simulator read_physics(const std::filesystem::path& path, bool tracks_bias, const Note& note) {
  const Simulator simulator = read_simulator(path);
  if (!tracks_bias) return simulator;
  std::vector<std::string> left_out;
  Simulator part = online_part(simulator, left_out);
  for (const auto& name : left_out) {
    note(path.string() + ": effect '" + name + "' is left to the bias tracker");
  }
  return part;
}

}  // namespace

OnlineCompensator open_compensator(const OnlineFiles& files, CompensatorOptions options,
                                   const Note& note) {
  const std::string where = files.model.string();
  const bool tracks_bias = options.bias_seconds > 0.0;
  std::optional<Identifier> identifier;
  std::optional<Simulator> physics;
  if (files.model.extension() == ".json") {
    require(files.fallback.empty(), Exit::kUsage, "--fallback steps in for a trained model; ",
            where, " is a simulator itself");
    require(files.precision == Precision::kSingle, Exit::kUsage,
            "--precision int16 is for a trained model; ", where, " is a simulator");
    physics = read_physics(files.model, tracks_bias, note);
  } else {
    identifier = read_identifier(files.model, files.precision);
    if (!files.fallback.empty()) {
      physics = read_physics(files.fallback, tracks_bias, note);
    } else if (identifier->base) {
      physics = identifier->base;
    }
  }
  options.R_ES = !files.calibration.empty() ? read_calibration(files.calibration).R_ES
                 : physics                  ? physics->model.R_ES()
                                            : mounting_of(identifier->layout);
  OnlineCompensator compensator(identifier ? &*identifier : nullptr, physics ? &*physics : nullptr,
                                options, where);
  if (!compensator.has_fallback()) {
    note("no --fallback: where the model cannot be trusted the output is held, then faded");
  }
  if (identifier && !compensator.has_envelope()) {
    note(where +
         ": has no envelope of training, unusual motion is not noticed; train it again with "
         "--online");
  }
  return compensator;
}

}  // namespace dcnn
