// SPDX-License-Identifier: Apache-2.0
// Effects concealed in recordings that somebody measured: real motion, real noise.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/conceal/scenario.h"
#include "dcnn/data/recording.h"

namespace dcnn::conceal {

struct Injection {
  /// "effect" or "effect@axis", drawn like those of a scenario; or a JSON file whose list is that
  /// of `hidden` in a configuration of dcnn-sim: those numbers as they are.
  std::string what;
  double amplitude = 1.0;  ///< of a drawn effect: rms on its strongest axis, in units of `noise`
  /// N (the unit of what a machine measures); else that of the log, from its second differences.
  std::optional<double> noise;
  std::filesystem::path simulator;            ///< sim.json of the tool in the recordings,
  std::filesystem::path system;               ///< or system.json of a machine of one axis
  std::vector<std::filesystem::path> motion;  ///< logs of pose and force on one clock, no gaps
  ReadOptions read;
};

/// Adds to the measured forces what the effects change in the simulator's force on that motion
/// (smoothed over some 20 ms), clips and rounds, and writes FOLDER/<name of each log>, sim.json (or
/// system.json) and the sealed answers; returns the seal's SHA-256. Error(kUsage) for effects that
/// cannot be added, Error(kData) for logs that cannot be used. Of a machine the axis moves along
/// base_x, its position is alpha, and what is measured drives it: there an effect adds what the
/// drive needs more.
std::string inject(const Injection& request, std::uint64_t seed,
                   const std::filesystem::path& folder, const std::filesystem::path& seal);

}  // namespace dcnn::conceal
