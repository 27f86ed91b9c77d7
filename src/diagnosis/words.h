// SPDX-License-Identifier: Apache-2.0
// Findings in plain words.
#pragma once

#include <string>

#include "dcnn/core/number.h"
#include "diagnosis/judgement.h"
#include "physics/found_numbers.h"

namespace dcnn {

/// The `parameters` of a finding with a value; of an axis of a machine their names have no unit.
FoundNumbers found_numbers(const Json& parameters, bool on_machine);

/// "dry friction of 0.42 N along the tool": what was found, with its leading number, of the
/// `parameters` of its finding.
std::string in_words(const Member& member, const Json& parameters);

/// A law whose strength follows a logged signal: its strengths where the signal is lowest and
/// highest, and by how long they come after it [s].
struct Following {
  std::string signal, unit;
  double low, high, at_low, at_high, lag;
};
/// "a spring along the tool that follows pressure, 0.3 N at 1 and 0.9 N at 4, 200 ms after it".
std::string driven_words(const EffectKind& kind, const std::string& place, const Following& law);

/// The unit of a strength's slope: "N*s/m per unit of pressure".
std::string per_signal(const std::string& unit, const Json& driven_by);

}  // namespace dcnn
