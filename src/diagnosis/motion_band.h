// SPDX-License-Identifier: Apache-2.0
// How fast a motion is, read from the positions that were logged.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace dcnn {

/// Three times the frequency [Hz] below which lies nine tenths of the power of the velocity:
/// spectra of Hann windows of 1 s (Welch 1967) of positions dt [s] apart, less the white noise of a
/// sensor, read as the median over the upper half of the bins; bins that chance lifts above it
/// (99.9 %) do not count. 0 where nothing stands out.
double motion_band(const std::vector<Eigen::VectorXd>& positions, double dt);

}  // namespace dcnn
