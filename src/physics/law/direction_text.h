// SPDX-License-Identifier: Apache-2.0
// How a law's direction is told.
#pragma once

#include <string>

#include "dcnn/physics/law.h"

namespace dcnn::law {

/// "(0.6, 0.8, 0)", an oblique axis, or the point in m; empty where the direction has no numbers.
std::string own_text(const Law& law);
/// In words: "the axis (0.6, 0.8, 0) of the base".
std::string direction_words(const Law& law);
/// Of a formula: "base(0.6, 0.8, 0)", "from_point(0.5, 0, 0.1)".
std::string direction_name(const Law& law);
/// How a law in words begins: "a force against the motion along the tool".
std::string beginning_words(const Law& law, const Terms& terms);

}  // namespace dcnn::law
