// SPDX-License-Identifier: Apache-2.0
// What a recording's columns mean: a tool on a wrist, or the axes of any other machine.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn {

/// One axis of a machine; empty names mean "not there".
struct Axis {
  std::string name, measured, unit;
  std::string position, velocity, acceleration, simulated;
  std::vector<std::string> signals, base;
  bool has_base = false;  ///< 'base' is given; an empty list, where no arm is known: a constant
  double scale = 1.0;
  /// Unless said "rad" where measured in N*m or A, "m" where in N, else "rad" where the position's
  /// name is an angle's, or empty.
  std::string position_unit;
};

struct System {
  enum class Kind { kWrist, kAxes };
  Kind kind = Kind::kWrist;
  std::vector<Axis> axes;
  double resample_hz = 0.0;  ///< 0: not asked for
  double lowpass_hz = 0.0;   ///< 0: none; else zero-phase on measured, simulated and base columns
  Json arm;                  ///< kinematics of an arm, null where absent
  Json json;                 ///< as given, for model files and reports; null for the default
};

/// From JSON; unknown keys and wrong types are Error(kData) naming `where`.
System parse_system(const Json& json, const std::string& where);
System read_system(const std::filesystem::path& path);

}  // namespace dcnn
