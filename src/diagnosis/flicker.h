// Noise that rises as 1/f below the band in which the floor is read.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/noise_floor.h"

namespace dcnn {

/// Density times frequency of 1/f noise beside these floors, by channel: the likeliest (Whittle)
/// for what is left below 10 Hz. None where that would be more than a slow part of a sensor's
/// noise.
std::optional<std::vector<double>> flicker_below(const Case& study, const Signals& left,
                                                 const std::vector<Floor>& floors);

}  // namespace dcnn
