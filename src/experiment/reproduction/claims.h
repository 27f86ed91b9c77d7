// SPDX-License-Identifier: Apache-2.0
// The paper's claims C1 to C5 (spec section 6), judged from numbers.
#pragma once

#include <string>
#include <vector>

#include "experiment/reproduction/results.h"

namespace dcnn {

struct Claim {
  enum class Verdict { kHolds, kFails, kNotTested };

  std::string id, text;
  Verdict verdict = Verdict::kNotTested;
  std::string numbers;  ///< what the verdict rests on, in words
};

/// C1 to C4 are averages over the noisy levels (the paper has no clean one), C4's time and C5 those
/// of Table I. A claim whose models or numbers are missing is not tested.
std::vector<Claim> judge_claims(const Scores& scores, const std::vector<Timing>& timings);

std::string verdict_word(Claim::Verdict verdict);  ///< "true", "false", "not tested"

}  // namespace dcnn
