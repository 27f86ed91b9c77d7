// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/features.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/lists.h"
#include "data/feature_blocks.h"
#include "data/limits.h"
#include "data/rows.h"
#include "dcnn/data/pose_noise.h"

namespace dcnn {
namespace {

using Set = FeatureSpec::Set;

constexpr double kRateTolerance = 0.01;
constexpr double kSingular = 0.05;  // |cos beta| below which Euler angles mean nothing

const std::vector<std::string> kSets = {"pose", "body", "axes"};  // in enum order

Eigen::Vector3d vector_of(Options& options, const std::string& key) {
  const auto numbers = options.get<std::vector<double>>(key, {0.0, 0.0, 0.0});
  if (numbers.size() != 3) options.reject(key, "must be a list of 3 numbers");
  const Eigen::Vector3d vector(numbers[0], numbers[1], numbers[2]);
  if (!vector.allFinite()) options.reject(key, "must be finite");
  return vector;
}

/// Six numbers, or none in the files of earlier versions and of systems without a pose.
Eigen::VectorXd parse_pose_deviation(Options& options) {
  const auto numbers = options.get<std::vector<double>>("pose_deviation", {});
  const Eigen::Map<const Eigen::VectorXd> deviation(numbers.data(),
                                                    static_cast<Index>(numbers.size()));
  if ((numbers.size() != 0 && numbers.size() != 6) || !deviation.allFinite() ||
      (deviation.array() < 0.0).any()) {
    options.reject("pose_deviation", "must be a list of 6 finite numbers from 0");
  }
  return deviation;
}

Json to_json(const FeatureSpec& spec) {
  return {{"set", kSets[static_cast<std::size_t>(spec.set)]},
          {"derivative", to_json(spec.derivative)},
          {"sensor_rotation_rpy", json_list(spec.sensor_rotation_rpy)}};
}

void check_rate(const Recording& recording, double dt) {
  require(std::abs(recording.dt - dt) <= kRateTolerance * dt, Exit::kData, recording.name,
          ": rate of ", 1.0 / recording.dt, " Hz instead of ", 1.0 / dt,
          " Hz as in training; use --resample ", 1.0 / dt);
}

void add_block(FeatureLayout& layout, const Block& block, const std::vector<Recording>& training) {
  const auto lacks = std::find_if(
      training.begin(), training.end(),
      [&](const Recording& recording) { return !is_available(block, recording, layout.system); });
  if (lacks != training.end()) {
    layout.notes.push_back("features " + joined(block.names, ",") + " left out: " + lacks->name +
                           " does not log what they need");
    return;
  }
  layout.names.insert(layout.names.end(), block.names.begin(), block.names.end());
  layout.units.insert(layout.units.end(), block.names.size(), block.unit);
}

/// What a derivative keeps and weighs at every sample is bounded.
void check_window(const FeatureLayout& layout, const std::string& where, Exit exit) {
  const DerivativeSpec& derivative = layout.spec.derivative;
  if (layout.dt <= 0.0) return;
  require(derivative.window(layout.dt) <= kLongestWindow, exit, where, ": derivative.window_s of ",
          derivative.window_s, " s is more than ", kLongestWindow, " samples of ", layout.dt,
          " s; shorten it");
}

}  // namespace

std::vector<Block> used_blocks(const FeatureLayout& layout, const std::string& where, Exit exit) {
  std::vector<Block> used;
  std::vector<std::string> names;
  for (const Block& block : feature_blocks(layout.spec, layout.system)) {
    const auto& all = layout.names;
    if (std::find(all.begin(), all.end(), block.names[0]) == all.end()) continue;
    used.push_back(block);
    names.insert(names.end(), block.names.begin(), block.names.end());
  }
  require(!names.empty() && names == layout.names, exit, where, ": the feature names ",
          joined(layout.names, ","), " do not belong to the set '",
          kSets[static_cast<std::size_t>(layout.spec.set)], "'");
  return used;
}

FeatureSpec parse_features(Options options, const System& system) {
  const bool axes = system.kind == System::Kind::kAxes;
  FeatureSpec spec;
  const std::string set = options.choice("set", axes ? "axes" : "pose", kSets);
  spec.set = static_cast<Set>(std::find(kSets.begin(), kSets.end(), set) - kSets.begin());
  if (axes != (spec.set == Set::kAxes)) {
    options.reject("set", "must be ", axes ? "axes" : "pose or body", " for this system, not '",
                   set, "'");
  }
  spec.derivative = parse_derivative(options.child("derivative"));
  spec.sensor_rotation_rpy = vector_of(options, "sensor_rotation_rpy");
  options.finish();
  return spec;
}

Json to_json(const FeatureLayout& layout) {
  Json json = {{"features", to_json(layout.spec)},
               {"system", layout.system.json},
               {"names", layout.names},
               {"units", layout.units},
               {"dt_s", layout.dt},
               {"circular_mean", json_list(layout.circular_mean)},
               {"notes", layout.notes}};
  const Eigen::VectorXd& d = layout.pose_deviation;
  if (d.size() > 0) json["pose_deviation"] = std::vector<double>(d.data(), d.data() + d.size());
  return json;
}

FeatureLayout parse_layout(const Json& json, const std::string& where, Exit exit) {
  Options options(json, where, exit);
  FeatureLayout layout;
  try {
    layout.system = parse_system(options.raw("system"), where);
  } catch (const Error& error) {
    throw Error(exit, error.what());
  }
  layout.spec = parse_features(options.child("features"), layout.system);
  layout.names = options.get<std::vector<std::string>>("names");
  layout.units = options.get<std::vector<std::string>>("units");
  layout.dt = options.number("dt_s", 0.0, 0.0, kSlowestStep);
  if (layout.dt > 0.0 && layout.dt < kFastestStep) {
    options.reject("dt_s", "must be 0 or at least ", kFastestStep, ", not ", layout.dt);
  }
  layout.circular_mean = vector_of(options, "circular_mean");
  layout.notes = options.get<std::vector<std::string>>("notes", {});
  layout.pose_deviation = parse_pose_deviation(options);
  options.finish();
  require(layout.names.size() == layout.units.size(), exit, where,
          ": there must be one unit per feature name");
  used_blocks(layout, where, exit);
  check_window(layout, where, exit);
  return layout;
}

FeatureLayout make_layout(const std::vector<Recording>& training, const FeatureSpec& spec,
                          const System& system) {
  require(!training.empty(), Exit::kUsage, "no training recording is given");
  FeatureLayout layout;
  layout.spec = spec;
  layout.system = system;
  if (system.kind == System::Kind::kAxes) layout.spec.set = Set::kAxes;
  layout.dt = training[0].dt;
  for (const Recording& recording : training) {
    if (recording.dt > 0.0 && layout.dt > 0.0) check_rate(recording, layout.dt);
    layout.dt = std::min(layout.dt, recording.dt);  // one static list: no feature needs time
  }
  check_window(layout, training[0].name, Exit::kUsage);
  for (const Block& block : feature_blocks(layout.spec, system)) add_block(layout, block, training);
  require(!layout.names.empty(), Exit::kData, training[0].name,
          ": holds no signal that a feature could be made of; log positions or velocities");
  if (layout.spec.set == Set::kPose) layout.circular_mean = circular_mean(training);
  if (layout.spec.set != Set::kAxes) layout.pose_deviation = pose_deviation(training);
  return layout;
}

Index Features::invalid_count() const { return std::count(valid.begin(), valid.end(), 0); }

Features make_features(const Recording& recording, const FeatureLayout& layout) {
  if (layout.dt > 0.0 && recording.dt > 0.0) check_rate(recording, layout.dt);
  const auto blocks = used_blocks(layout, recording.name, Exit::kData);
  for (const Block& block : blocks) {
    require(is_available(block, recording, layout.system), Exit::kData, recording.name,
            ": does not log what the features ", joined(block.names, ","),
            " need; add the columns the training recordings have");
  }
  Features features;
  features.valid.assign(static_cast<std::size_t>(recording.samples()), 1);
  if (layout.spec.set == Set::kAxes) {
    features.x = axis_features(recording, layout, blocks);
    return features;
  }
  features.x = wrist_features(recording, layout, blocks);
  if (layout.spec.set == Set::kPose) {
    for_each_row(recording.samples(), [&](Index i) {
      features.valid[static_cast<std::size_t>(i)] =
          std::abs(elementary::cos(features.x(i, 1))) >= kSingular;
    });
  }
  return features;
}

}  // namespace dcnn
