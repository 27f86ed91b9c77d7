// SPDX-License-Identifier: Apache-2.0
// The rows of the comparison: model kinds, some of them in several readings of the paper.
#pragma once

#include <string>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn {

struct Entry {
  enum class Group { kPaper, kReading, kOwn };

  std::string name, label;
  std::string kind;    ///< of the registry
  Json configuration;  ///< laid on the preset's
  Group group = Group::kOwn;
  double training_s = 10;   ///< preset `standard`, on two cores
  double pass_s = 0.5;      ///< one prediction of 32045 samples
  int look = 15;            ///< in every figure
  bool looks_back = false;  ///< every sample is predicted, also where few are scored
};

/// Prediction zero: nothing to train.
inline const std::string kNoIdentification = "ns";

/// Those whose kind is registered, in the order of Fig. 5, then further readings, then our own.
/// `wanted` (names; empty: all that the preset has) chooses; an unknown one is Error(kUsage).
std::vector<Entry> choose_entries(const std::vector<std::string>& wanted,
                                  const std::string& preset);

/// The paper times every identifier but the absent one.
bool timed(const Entry& entry);

}  // namespace dcnn
