// SPDX-License-Identifier: Apache-2.0
// Findings as a reader wants them: one line for the friction of one axis, no numbers that mean
// nothing. report.json keeps every finding as it was found.
#pragma once

#include "dcnn/core/json.h"

namespace dcnn {

/// Whether a spring is a constant force: the interval of its stiffness holds zero, or its rest lies
/// turns away.
bool is_constant(const Json& finding);
/// What is then to be said of it.
std::string constant_words(const Json& finding);

/// Several frictions along one axis in words, in order of their share of the curve: "friction: 12
/// N·m dry, 30 N·m·s/rad viscous, 4 mrad of presliding".
std::string friction_words(const Json& findings);

}  // namespace dcnn
