// SPDX-License-Identifier: Apache-2.0
// With which probability a recording decides between structures.
#pragma once

namespace dcnn::design {

/// A true structure against a rival on one recording: the rival's chi-square, both refitted,
/// exceeds the true one's by a non-central chi-square of `own` degrees of freedom and
/// non-centrality `separation`, less a central one of `rival` degrees: numbers that only the one or
/// only the other has.
struct Contest {
  double separation = 0.0;
  double own = 0.0, rival = 0.0;
};

/// P(difference > threshold).
double probability_above(const Contest& contest, double threshold);

/// The chi-square that the rival must have above the true structure, on all recordings, for
/// dcnn-diagnose to list it no more; `more` is how many numbers the rival has more.
double exclusion_threshold(int more);

}  // namespace dcnn::design
