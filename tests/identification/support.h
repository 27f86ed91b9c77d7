// SPDX-License-Identifier: Apache-2.0
// Simulated recordings of a known tool, as files.
#pragma once

#include <cmath>
#include <filesystem>

#include "data/testing.h"
#include "dcnn/data/csv.h"
#include "dcnn/identification/identify.h"
#include "dcnn/physics/scenario.h"
#include "support/process.h"

namespace dcnn::identification_tests {

inline Json tool_json(bool torque = true) {
  Json tool{{"mass_kg", 0.75}, {"com_m", {0.004, -0.006, 0.16}}};
  if (torque) tool["inertia_kgm2"] = {0.0215, 0.0213, 0.0009, 0.0001, -0.0005, 0.0008};
  return {{"tool", tool},
          {"sensor", {{"bias_n", {0.6, -0.4, 1.1}},
                      {"bias_nm", {0.02, -0.01, 0.03}},
                      {"rotation_rpy", {-0.0262, 0.0349, -0.5236}}}}};
}

inline Json trajectory(double fastest = 1.0) {
  return {{"kind", "multisine"}, {"tones", 6}, {"hz", {0.03, fastest}},
          {"position_m", {0.12, 0.12, 0.12}}, {"angle_rad", {1.05, 0.61, 0.7}},
          {"angle_center_rad", {0.0, 0.0, 3.14159}}};
}

struct Setting {
  Json simulator = tool_json(), path = trajectory(), hidden = Json::array();
  int samples = 15000;
  double noise_n = 0.04, noise_nm = 0.002, ar = 0.0;
  std::uint64_t seed = 1;
};

inline Scenario simulated(const Setting& s) {
  Json recording{{"name", "log"}, {"samples", s.samples}, {"trajectory", s.path}};
  return simulate_config({{"seed", s.seed},
                          {"sample_rate_hz", 500},
                          {"simulator", s.simulator},
                          {"pose_noise", {{"m", 5e-6}, {"rad", 5e-6}}},
                          {"force_noise", {{"n", s.noise_n}, {"nm", s.noise_nm}, {"ar", s.ar}}},
                          {"recordings", Json::array({recording})},
                          {"hidden", s.hidden}},
                         "test");
}

/// What is identified from the first recording of a setting.
inline ToolIdentification identified(const Setting& s, IdentifyRequest request = {}) {
  const test::TemporaryFolder folder;
  const auto file = folder / "log.csv";
  write_csv(file, simulated(s).recordings[0].noisy.table);
  request.logs = {file};
  return identify_tool(request);
}

inline const IdentifiedNumber& number(const ToolIdentification& id, const std::string& name) {
  for (const IdentifiedNumber& e : id.parameters) {
    if (e.name == name) return e;
  }
  throw std::runtime_error("no parameter " + name);
}

}  // namespace dcnn::identification_tests
