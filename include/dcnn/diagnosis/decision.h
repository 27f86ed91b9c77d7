// SPDX-License-Identifier: Apache-2.0
// When the diagnosis lists a model beside the one that it chose: the rule that a design predicts.
#pragma once

namespace dcnn {

/// Chi-square that a fitted number must gain.
constexpr double kNumberPrice = 10.0;
/// On a machine, which leaves more than its sensor's noise: the share of what is left that a fitted
/// number must take off.
constexpr double kMachineShare = 0.04;
/// Chi-square by which a model with as many numbers may fit worse and still be listed: e^6, 400
/// to 1.
constexpr double kAsLikely = 12.0;
/// Share of the price of each further number that a model with more of them must gain to be listed.
constexpr double kLeastOfMore = 0.5;

}  // namespace dcnn
