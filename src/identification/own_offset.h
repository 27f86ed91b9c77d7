// SPDX-License-Identifier: Apache-2.0
// Whether a list of poses at rest has an offset of its own.
#pragma once

#include "identification/whitener.h"

namespace dcnn::identification {

/// Twice the logarithm of the likelihood that an offset in each channel gains in `residual`, (n,
/// channels) of independent rows, where their deviation is estimated with the offset and without
/// it: n ln(s0^2/s1^2). A deviation estimated without it holds the offset itself, and a few rows
/// far off would look like a noisy log. `least`: the deviation in other logs of the same sensor,
/// below which none is assumed.
double own_offset_gain(const Eigen::MatrixXd& residual, const Eigen::VectorXd& least);

/// The least deviation of each channel in the logs but for `but`.
Eigen::VectorXd least_deviations(const std::vector<std::vector<ChannelNoise>>& noise,
                                 std::size_t but);

}  // namespace dcnn::identification
