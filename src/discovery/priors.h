// SPDX-License-Identifier: Apache-2.0
// Every prior and level of the discovery, in one table. Chi-square throughout.
#pragma once

namespace dcnn::discovery::prior {

/// Of each fitted number: ln of some thousand rows that tell it (Schwarz 1978).
constexpr double kNumber = 7.0;
/// Of each fitted number, as a share of the largest gain: relative error of the motion, which must
/// not buy factors where a law is strong.
constexpr double kModelError = 2e-4;
constexpr double kFactor = 6.0;  ///< of each factor beyond the first
constexpr double kMemory = 4.0;  ///< of each state or lag
/// Least gain, over the inflation of its variance, less the penalty: of the best of some 10^5
/// columns tried on noise, one in 100 passes.
constexpr double kAccepted = 30.0;
/// Least share of the gain that folds show to which the numbers were not fitted.
constexpr double kHeldOutShare = 0.5;
/// Least exponent: below it a power is a sign or a constant.
constexpr double kLeastPower = 0.2;
/// Weight of the second differences of a curve, of the mean information on its nodes.
constexpr double kBending = 1e-2;
constexpr double kBlockSeconds = 8.0;  ///< of blocks for folds and for constancy
/// Variance of the strength over blocks above which the form is not established.
constexpr double kConstant = 3.0;
/// Margin within which another form is a rival: chi-square, and as a share of the gain.
constexpr double kRival = 10.0, kRivalShare = 1e-4;
constexpr int kMostLaws = 5;     ///< terms of a sum
constexpr int kMostEvolved = 2;  ///< of them whose forms are searched
/// Chi-square per row at which a sum of terms is enough.
constexpr double kNoise = 1.05;
/// Seconds over which coloured residuals are correlated at most.
constexpr double kCorrelated = 8.0;

}  // namespace dcnn::discovery::prior
