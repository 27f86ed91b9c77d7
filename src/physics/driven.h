// SPDX-License-Identifier: Apache-2.0
// A law whose strength follows a logged signal s: a + slope·s(t - lag) in place of a.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dcnn/physics/effect.h"

namespace dcnn {

/// Of an effect's parameters: driven_by, the signal's column; slope, in the strength's unit for
/// each unit of the signal; lag_s, by how long the strength comes after the signal.
struct Drive {
  std::string signal;
  double slope = 0.0, lag = 0.0;
};

/// None where nothing drives the law. An error where its kind has no strength that may follow one.
std::optional<Drive> read_drive(const EffectKind& kind, Options& parameters);

/// Adds what the driven law does. Error(kData) where the motion lacks the signal.
void apply_driven(const Drive& drive, const EffectSpec& effect, const Motion& motion,
                  const ToolModel& model, Wrench& wrench);

/// The signals that drive one of the effects, or that a discovered law takes.
std::vector<std::string> signals_of(const std::vector<EffectSpec>& effects);
/// Adds those of them that the recording has to its motion.
void read_signals(const Recording& recording, const std::vector<std::string>& names,
                  Motion& motion);

}  // namespace dcnn
