// SPDX-License-Identifier: Apache-2.0
// Whether the strength of a member depends on what its law does not know of.
#pragma once

#include <vector>

#include "diagnosis/joint_fit.h"

namespace dcnn {

/// For each member, what more of it would explain if its strength grew, or bent, with the time, an
/// angle, a position, a speed or a force: the most of these, beside the whole model, less what more
/// than one number gain by chance. Near a law's relative (friction that grows with the load, a
/// spring that stiffens) this is large although hardly anything is left. 0 for modes, whose ringing
/// depends on motion that nobody sees.
std::vector<double> modulations(const Setting& setting, const JointFit& fit);

/// What another mode on the axis of this one would explain beside the whole model: where it is
/// much, the one stands for several.
double second_mode(const Setting& setting, const JointFit& fit, const Member& mode);

}  // namespace dcnn
