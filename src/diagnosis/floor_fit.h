// SPDX-License-Identifier: Apache-2.0
// The shape of a floor that is likeliest under the density of its quiet band (Whittle 1953).
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

#include "diagnosis/noise_floor.h"

namespace dcnn {

/// Of noise of a given shape.
struct Whittle {
  double level = 0.0, likelihood = 0.0;
};

/// The level of noise of this shape, and its log-likelihood up to a constant.
Whittle fit_level(const Eigen::VectorXd& density, const Eigen::VectorXd& shape, double windows);

/// White noise, or of a colour (an AR process, 1/f, a filter) that is so much likelier, from the
/// density of a quiet band at `hz`, a mean over so many windows. `is_refuted` says what the bins
/// below the band refute.
Floor fit_floor(const Eigen::VectorXd& density, const Eigen::VectorXd& hz, double dt,
                double windows, bool flat, const std::function<bool(const Floor&)>& is_refuted);

/// The quiet band of a channel, without its lines.
struct QuietBand {
  Eigen::VectorXd density, hz;
  double windows = 0.0;
};

/// All channels of a sensor pass the same filters. Where chance in one octave refuted every colour
/// of a channel, that of another is taken which its quiet band bears out, with a level of its own:
/// whether any was.
bool share_colours(const std::vector<QuietBand>& bands, std::vector<Floor>& floors);

}  // namespace dcnn
