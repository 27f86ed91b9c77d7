// SPDX-License-Identifier: Apache-2.0
// Units and the sign of forces, all at once: where two or three are wrong, mending one of them may
// explain no more than mending none.
#pragma once

#include "check/reading.h"

namespace dcnn::check {

/// A reading of some kinds' faults together: `parts` is the chain of readings from the declared one
/// to it, one fault further each.
struct Combined {
  std::vector<Reading> parts;
  std::vector<double> probability;  ///< of each part's kind, against `rival` and all combinations
};

/// The likeliest combination of the kinds that combine; no parts where `rival`, whose prior is that
/// of all its faults, is likelier than all of them together.
Combined combine(const Log& log, const Sampled& rows, const Reading& declared,
                 const Reading& rival);

}  // namespace dcnn::check
