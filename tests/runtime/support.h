// SPDX-License-Identifier: Apache-2.0
// A small tool in motion, a model of it and a compensator for the tests of the runtime room.
#pragma once

#include <algorithm>

#include "dcnn/data/rotation.h"
#include "dcnn/physics/scenario.h"
#include "dcnn/runtime/compensator.h"

namespace dcnn::test {

inline Json small_world(Index samples, double seconds_before = 0.0, double speed = 1.0) {
  const Json motion = {{"kind", "multisine"},
                       {"tones", 6},
                       {"hz", {0.15 * speed, 1.0 * speed}},
                       {"position_m", {0.1, 0.1, 0.1}},
                       {"angle_rad", {0.6, 0.5, 0.6}},
                       {"angle_center_rad", {0, 0, 3.14159}}};
  return {{"seed", 5},
          {"sample_rate_hz", 500},
          {"force_noise", {{"n", 0.04}}},
          {"pose_noise", {{"m", 5e-6}, {"rad", 5e-6}}},
          {"simulator",
           {{"tool", {{"mass_kg", 0.75}, {"com_m", {0.004, -0.006, 0.16}}}},
            {"sensor", {{"bias_n", {0.6, -0.4, 1.1}}, {"rotation_rpy", {-0.03, 0.03, -0.5}}}}}},
          {"recordings", Json::array({{{"name", "free"},
                                       {"samples", samples},
                                       {"t0_s", seconds_before},
                                       {"trajectory", motion}}})}};
}

/// Free motion of the tool: a pose and what the sensor reads.
inline Recording free_motion(Index samples, double seconds_before = 0.0, double speed = 1.0) {
  return simulate_config(small_world(samples, seconds_before, speed), "test").recordings[0].noisy;
}

inline Simulator small_tool() {
  return parse_simulator(small_world(2)["simulator"], "test", Exit::kUsage);
}

/// A model of the kind, trained on 20 s of free motion with causal features.
inline Identifier trained(const std::string& kind = "rigid") {
  const Recording recording = free_motion(10000);
  FeatureSpec spec;
  spec.set = FeatureSpec::Set::kBody;
  spec.sensor_rotation_rpy = small_tool().model.sensor_rotation_rpy;
  spec.derivative = causal_derivative();
  Identifier identifier;
  identifier.name = kind;
  identifier.layout = make_layout({recording}, spec, {});
  identifier.targets = {{"fx", "fy", "fz"}, {"N", "N", "N"}};
  identifier.configuration = model_kind(kind, Exit::kUsage).preset("quick", false);
  identifier.configuration["noise"] = {{"levels_db", Json::array({nullptr})}};
  identifier.model = model_kind(kind, Exit::kUsage)
                         .make({identifier.layout, identifier.targets, identifier.configuration,
                                "test", 1, false});
  Samples samples;
  samples.x = make_features(recording, identifier.layout).x;
  samples.y = recording.block(identifier.targets.names);
  samples.segments = recording.segments;
  FitSession session;
  identifier.model->fit(samples, {}, session);
  identifier.online =
      learn_limits(*identifier.model, identifier.targets, samples, {}, identifier.layout.dt);
  return identifier;
}

/// Row k of a recording, with a force in B on the tool.
inline OnlineSample sample_of(const Recording& recording, Index k,
                              const Eigen::Vector3d& touch_B = Eigen::Vector3d::Zero()) {
  const auto& values = recording.table.values;
  const auto at = [&](const char* name) {
    const auto& names = recording.table.columns;
    return values(k, std::find(names.begin(), names.end(), name) - names.begin());
  };
  OnlineSample sample;
  sample.t = at("t");
  sample.position = {at("x"), at("y"), at("z")};
  sample.euler = Eigen::Vector3d(at("alpha"), at("beta"), at("gamma"));
  const Eigen::Matrix3d R_BE = rotation_from_euler(*sample.euler);
  const Eigen::Quaterniond q(R_BE);
  sample.quaternion = {q.w(), q.x(), q.y(), q.z()};
  const Eigen::Matrix3d R_BS = R_BE * small_tool().model.R_ES();
  sample.wrench.head<3>() =
      Eigen::Vector3d(at("fx"), at("fy"), at("fz")) + R_BS.transpose() * touch_B;
  return sample;
}

inline CompensatorOptions mounted_options() {
  CompensatorOptions options;
  options.R_ES = small_tool().model.R_ES();
  return options;
}

}  // namespace dcnn::test
