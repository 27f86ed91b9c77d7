// SPDX-License-Identifier: Apache-2.0
// Parts of the diagnosis that can be left out, to measure what each is worth. For research: a
// report made without one says so.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace dcnn {

/// true: left out.
struct Ablation {
  bool refinement = false;        ///< shapes stay at their seeds
  bool exact_operators = false;   ///< delay and lag are -s dF/dt
  bool projection = false;        ///< candidates as if nothing were fitted beside them
  bool smoothing = false;         ///< no columns for a little more or less smoothing of the pose
  bool coloured_floor = false;    ///< the floor's spectrum is flat
  bool omnibus = false;           ///< nobody asks what no name explains
  bool exchange = false;          ///< what was added first stays: no swaps, no pairs
  bool flips = false;             ///< no name is tested against random signs of the residual
  std::set<std::string> effects;  ///< of the catalogue: the diagnosis does not know their names

  /// Names of the parts that are left out, as ablation_of() takes them.
  std::vector<std::string> names() const;
};

/// refinement, exact-operators, projection, smoothing, coloured-floor, omnibus, exchange, flips,
/// and every effect's name.
const std::vector<std::string>& ablations();
/// Error(kUsage) for another name.
Ablation ablation_of(const std::vector<std::string>& parts);

}  // namespace dcnn
