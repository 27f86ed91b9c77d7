// SPDX-License-Identifier: Apache-2.0
// How probable nothing, names, an unknown, and each name are: one score for all structures.
#pragma once

#include <functional>

#include "diagnosis/evidence/structure.h"

namespace dcnn::evidence {

struct Posterior {
  double nothing = 0.0, named = 0.0, named_and_unknown = 0.0, unknown = 0.0;
  std::vector<Structure> structures;
  std::vector<double> without_unknown, with_unknown;  ///< masses of the structures, of sum 1

  /// Mass of the structures that hold an effect of this kind on this axis.
  double inclusion(const Member& member) const;
  /// Every structure holds a law without a name: that is what is unknown.
  void hold_a_law();
  /// The structure of the largest mass, with and without an unknown.
  std::size_t most_probable() const;
};

/// A probability after data of likelihood ratio exp(log_factor); no nearer to 0 or 1 than half of
/// prior::kElsewhere.
double updated(double probability, double log_factor);
/// A name's probability where with another, `elsewhere`, the truth is none of the structures that
/// were weighed, which then hold the name as often as not.
double with_elsewhere(double probability, double elsewhere);

/// Normalised over the structures at hand: log_named, improved by slow noise where that is
/// likelier, against log_named and the unknown's factor; differences beside an unknown are tempered
/// by 1/(1 + gain/kTempering), where its class keeps its whole mass.
/// `found_apart`: effects that tests of their own have found stand in every structure.
Posterior posterior_of(std::vector<Structure> structures, bool found_apart);

}  // namespace dcnn::evidence
