// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "dcnn/data/rotation.h"
#include "models/frame_tcn/model.h"

namespace dcnn {
namespace frame_tcn {
namespace {

std::vector<double> read_numbers(Options& options, const std::string& key,
                                 std::vector<double> fallback, double low, double high) {
  const auto list = options.get(key, std::move(fallback));
  const bool good =
      std::all_of(list.begin(), list.end(), [=](double v) { return v >= low && v <= high; });
  if (list.empty() || list.size() > 16 || !good) {
    options.reject(key, "must hold 1 to 16 numbers between ", low, " and ", high);
  }
  return list;
}

void read_model(Options options, Spec& spec) {
  options.raw("name");
  const auto front = options.choice("front", "experts", {"experts", "line", "dense"});
  spec.line = front == "line";
  spec.dense = front == "dense";
  spec.gates = options.get("gates", true) && !spec.line;
  spec.saturation = options.get("saturation", true);
  spec.speeds = read_numbers(options, "time_scales", {0.7, 0.85, 1.0, 1.2, 1.45}, 0.1, 10.0);
  const auto on = spec.noise.on;
  auto x = read_numbers(options, "experts_x_db", {8, 14, 20, 26, 33, 41, 50, 65}, -20.0, 200.0);
  auto pose =
      read_numbers(options, "experts_pose_db", {8, 16, 24, 32, 40, 50, 62, 85}, -20.0, 200.0);
  if (!spec.gates) {  // one filter must do for every level: that of a middle one
    x = {20.0};
    pose = {32.0};
  }
  if (on != NoiseSpec::Signal::kPose) spec.x_snr = x;
  const bool one_filter = !spec.gates && !spec.x_snr.empty();
  if (on != NoiseSpec::Signal::kFeatures && !one_filter) spec.pose_snr = pose;
  options.finish();
}

void read_training(Options options, Spec& spec) {
  spec.epochs = static_cast<Index>(options.number("epochs", 30, 1, 1e5));
  spec.steps = static_cast<Index>(options.number("steps", 100, 1, 1e6));
  spec.gate_rate = options.number("lr_gates", 5e-3, 1e-9, 1.0);
  spec.head_rate = options.number("lr", 2e-3, 1e-9, 1.0);
  spec.ema = options.number("ema", 0.998, 0.0, 0.999999);
  for (const char* key : {"validation", "candidates", "candidate_epochs"}) {
    options.raw(key);  // read by the experiment
  }
  options.finish();
}

Json frame_tcn_preset(const std::string& preset, bool /*axes*/) {
  Json json = {{"features", {{"set", "pose"}}}, {"training", {{"epochs", 30}, {"steps", 100}}}};
  if (preset == "quick") json["training"]["epochs"] = 6;
  if (preset == "fair" || preset == "paper") json["training"]["epochs"] = 60;
  return json;
}

std::unique_ptr<Model> make_frame_tcn(const Problem& problem) {
  return std::make_unique<FrameTcn>(problem);
}

std::unique_ptr<Model> load_frame_tcn(const Container& file, const std::string& where) {
  return std::make_unique<FrameTcn>(file, where);
}

}  // namespace

Spec Spec::parse(const Problem& problem) {
  Options options(problem.configuration, problem.where, Exit::kUsage);
  Spec spec;
  spec.noise = parse_noise(options.child("noise"));
  read_model(options.child("model"), spec);
  read_training(options.child("training"), spec);
  options.child("map").finish();  // it has no map to configure
  spec.mounting = rotation_from_euler(problem.layout.spec.sensor_rotation_rpy.reverse());
  spec.layout = problem.layout;
  spec.seed = problem.seed;
  return spec;
}

Index Spec::experts() const {
  if (dense) return kBlocks;
  return line ? 1 : static_cast<Index>(x_snr.size() + pose_snr.size());
}

}  // namespace frame_tcn

extern const ModelKind frame_tcn_model;
const ModelKind frame_tcn_model{
    "frame-tcn",
    "causal convolutions per axis, gates by noise, frames and a product head (paper: as fair)",
    frame_tcn::frame_tcn_preset, frame_tcn::make_frame_tcn, frame_tcn::load_frame_tcn};

}  // namespace dcnn
