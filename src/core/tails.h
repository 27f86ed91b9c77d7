// SPDX-License-Identifier: Apache-2.0
// Upper tails of counts and of the normal distribution. Terms of counts are those of Loader (2000),
// "Fast and accurate computation of binomial probabilities": deviances instead of differences of
// large logarithms; relative error below 1e-12 up to some hundred events, 1e-14 per event beyond.
#pragma once

namespace dcnn {

/// Probability of `count` events or more where `mean` are expected (Poisson). A part of an event is
/// none: count is rounded down.
double poisson_tail(double count, double mean);

/// Probability of `count` successes or more among `trials`, each of this probability (binomial).
double binomial_tail(double count, double trials, double probability);

/// 95 % of a standard normal variable lie within so many deviations either way.
constexpr double kNormal95 = 1.96;

/// Probability of more than `z` for a standard normal variable; relative error below 1e-13.
double normal_tail(double z);

}  // namespace dcnn
