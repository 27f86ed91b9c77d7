// SPDX-License-Identifier: Apache-2.0
// Simulated recordings in which effects are hidden, and their diagnosis.
#pragma once

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "dcnn/core/file.h"
#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/scenario.h"
#include "support/process.h"

namespace dcnn::test {

/// Samples of a recording, at 500 Hz.
constexpr int kSamples = 10000;

inline Json recording(const char* name, double t0) {
  return {{"name", name},
          {"samples", kSamples},
          {"t0_s", t0},
          {"trajectory",
           {{"kind", "multisine"},
            {"tones", 6},
            {"hz", {0.05, 1.0}},
            {"position_m", {0.12, 0.12, 0.12}},
            {"angle_rad", {1.05, 0.61, 0.7}},
            {"angle_center_rad", {0.0, 0.0, 3.14159}}}}};
}

/// Two recordings of a tool with these effects hidden, 0.04 N of noise.
inline Json configuration(const Json& hidden) {
  return {{"seed", 5},
          {"simulator",
           {{"tool", {{"mass_kg", 0.75}, {"com_m", {0.004, -0.006, 0.16}}}},
            {"sensor", {{"bias_n", {0.1, -0.2, 0.3}}}}}},
          {"pose_noise", {{"m", 5e-6}, {"rad", 5e-6}}},
          {"force_noise", {{"n", 0.04}}},
          {"recordings", {recording("fit", 0.0), recording("hold", 25.0)}},
          {"hidden", hidden}};
}

/// The same at half the rate in noise of the same density: what changes over many rows is told as
/// well by half of them, in half the time.
inline Json at_half_rate(Json configuration) {
  const double quieter = std::sqrt(0.5);
  configuration["sample_rate_hz"] = 250.0;
  for (const char* key : {"pose_noise", "force_noise"}) {
    for (auto& [name, deviation] : configuration[key].items()) {
      deviation = quieter * deviation.get<double>();
    }
  }
  for (Json& each : configuration["recordings"]) each["samples"] = kSamples / 2;
  return configuration;
}

/// Recordings and the nominal simulator in a folder of their own.
class Bench {
 public:
  explicit Bench(const Json& configuration) {
    const Scenario scenario = simulate_config(configuration, "test");
    for (const auto& r : scenario.recordings) write_csv(folder_ / (r.name + ".csv"), r.noisy.table);
    write_file(folder_ / "sim.json", scenario.simulator.dump());
  }
  DiagnosisRequest request(bool holdout = true) const {
    DiagnosisRequest request;
    request.simulator = folder_ / "sim.json";
    request.fit = {folder_ / "fit.csv"};
    if (holdout) request.holdout = {folder_ / "hold.csv"};
    return request;
  }
  Diagnosis diagnose(bool holdout = true) const {
    return dcnn::diagnose(request(holdout), nullptr);
  }
  /// The same where the forces of the simulator are columns of the recordings, and no more is known
  /// of it.
  Diagnosis diagnose_columns() const { return dcnn::diagnose(request_of_columns(), nullptr); }
  /// Writes those columns.
  DiagnosisRequest request_of_columns() const {
    const Simulator simulator = read_simulator(folder_ / "sim.json");
    for (const char* name : {"fit.csv", "hold.csv"}) {
      Recording log = read_recording(folder_ / name, ReadOptions(), System());
      const Recording simulated = predict_motion(simulator, log, DerivativeSpec());
      for (const std::string axis : {"fx", "fy", "fz"}) {
        log.set(axis + "_sim", simulated.column(axis));
      }
      write_csv(folder_ / name, log.table);
    }
    DiagnosisRequest by_columns = request();
    by_columns.simulator.reset();
    return by_columns;
  }
  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  TemporaryFolder folder_;
};

/// Changes the recordings of a bench by hand.
template <class Change>
void change(const Bench& bench, const Change& by) {
  for (const char* name : {"fit.csv", "hold.csv"}) {
    Recording log = read_recording(bench / name, ReadOptions(), System());
    by(log);
    write_csv(bench / name, log.table);
  }
}

inline Json hidden(const char* effect, const Json& axis, const Json& parameters) {
  return {{"effect", effect}, {"axis", axis}, {"parameters", parameters}};
}

/// Dry and viscous friction along each axis of the base.
inline Json frictions_along_base() {
  Json frictions = Json::array();
  for (const char* axis : {"base_x", "base_y", "base_z"}) {
    frictions.push_back(hidden("coulomb_friction", axis, {{"fc_n", 0.2}, {"v0_mps", 0.01}}));
    frictions.push_back(hidden("viscous_friction", axis, {{"c_nspm", 1.0}}));
  }
  return frictions;
}

/// The effects of the catalogue that were found, in the order of the report.
inline std::vector<std::string> names(const Json& report) {
  std::vector<std::string> list;
  for (const Json& f : report["findings"]) {
    if (f["effect"] != "discovered") list.push_back(f["effect"].get<std::string>());
  }
  return list;
}

inline std::set<std::string> found(const Json& report) {
  const auto list = names(report);
  return {list.begin(), list.end()};
}

}  // namespace dcnn::test
