// SPDX-License-Identifier: Apache-2.0
// Simulated recordings with ground truth, from one configuration.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"

namespace dcnn {

/// One entry of `recordings`.
struct SimulatedRecording {
  std::string name;  ///< without extension
  Recording noisy;   ///< what a log would hold
  /// The noise-free pose, the exact rates (vx … dwz, in S), the forces without sensor noise, and
  /// the rigid tool's share of them (fx_tool …: true tool, no effect, no bias).
  Recording clean;
};

struct Scenario {
  std::vector<SimulatedRecording> recordings;
  Json simulator;  ///< sim.json: the nominal simulator, without what is hidden
  Json truth;      ///< truth.json: seed, true tool, hidden effects, noise, trajectories
};

/// Keys: seed, sample_rate_hz, simulator, orientation (euler|quaternion), pose_noise {m, rad},
/// force_noise {n, nm, ar}, recordings [{name, samples, t0_s, trajectory}], hidden [effects].
/// Recording k draws from streams of its own, (seed, k, purpose). Faults are Error(kUsage).
Scenario simulate_config(const Json& config, const std::string& where,
                         std::optional<std::uint64_t> seed_override = std::nullopt);

/// Writes <name>.csv and <name>_clean.csv of every recording, sim.json and truth.json into
/// `folder`.
void write_scenario(const Scenario& scenario, const std::filesystem::path& folder);

}  // namespace dcnn
