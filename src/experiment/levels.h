// SPDX-License-Identifier: Apache-2.0
// Noise levels in reports.
#pragma once

#include "dcnn/core/json.h"
#include "dcnn/data/noise.h"
#include "experiment/markup.h"

namespace dcnn {

/// "clean", "20 dB".
inline std::string level_name(const SnrLevel& level) {
  return level ? significant(*level, 4) + " dB" : "clean";
}

/// [dB]; null is clean.
inline Json level_json(const SnrLevel& level) { return level ? Json(*level) : Json(); }

}  // namespace dcnn
