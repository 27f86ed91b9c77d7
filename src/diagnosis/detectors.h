// SPDX-License-Identifier: Apache-2.0
// Tests for what has no column in a linear model: rounding, clipping, impacts, lines above the
// blocks' band.
#pragma once

#include <vector>

#include "diagnosis/search.h"

namespace dcnn {

/// Step of a lattice on which the values of every force channel lie, 0 for none above 0.9 mN (what
/// a log's own decimals make is finer).
double rounding_step(const Case& study);
/// The finest step of the log itself: its last decimal, or what a printer rounded to.
double reading_digit(const Case& study);
/// Standard deviation of a step that was read off the whole range of the values.
double rounding_deviation(const Case& study, double step);

/// A limit at which at least 20 samples of a channel stand, and the rows they disturb.
struct Clipping {
  Index channel = -1;
  double limit = 0.0;
  std::vector<Span> spans;
};
std::vector<Clipping> clipping(const Case& study);

/// The strongest line above what block means can show, fitted at the log's rate.
std::optional<Member> find_fast_hum(const Case& study, const Signals& left,
                                    const std::vector<Floor>& floors);

/// Whether it is a line that was found so.
bool is_heard_hum(const Member& member);

}  // namespace dcnn
