// SPDX-License-Identifier: Apache-2.0
// What a report leaves open: the structures that may be true, as probable as the report says.
#pragma once

#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/physics/simulator.h"

namespace dcnn::design {

/// One set of effects with their numbers.
struct Hypothesis {
  std::vector<EffectSpec> effects;
  double mass = 1.0;        ///< probability; those of all and the unknown sum to 1
  double chi2_above = 0.0;  ///< on the recordings at hand, above the chosen
  int more_numbers = 0;     ///< than the chosen has
};

struct Question {
  ToolModel tool;                      ///< the simulator that was given
  std::vector<Hypothesis> hypotheses;  ///< the chosen first, then by mass
  double unknown = 0.0;                ///< probability of physics that no name describes
  std::vector<double> noise;           ///< deviation of a sample, of each channel
  std::vector<int> channels;           ///< columns of (fx,fy,fz,tx,ty,tz)
  double sample_rate_hz = 500.0;       ///< at which `noise` was read
  double start_s = 0.0;                ///< on the clock of the recordings, when the next one begins

  /// The effects of the chosen one; "nothing" for none.
  std::string chosen() const;
  /// What `one` holds and `other` does not, "coulomb_friction tool_z"; "nothing" where that is
  /// nothing.
  std::string name_of(std::size_t one, std::size_t other) const;
};

/// From report.json and model.json of a tool on a wrist. Error(kData) where they hold no such
/// thing.
Question question_of(const Json& report, const Json& model, const std::string& where);

}  // namespace dcnn::design
