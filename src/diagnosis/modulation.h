// SPDX-License-Identifier: Apache-2.0
// Whether the strength of a member depends on what its law does not know of.
#pragma once

#include <vector>

#include "diagnosis/joint_fit.h"

namespace dcnn {

/// What more of a member would explain, in chi-square, if its strength grew, or bent, with
/// something: beside the whole model, less what more than one number gain by chance; and the same
/// over the overdispersion of the residual shifted in time (judgement.h).
struct Modulation {
  double gain = 0.0, beyond = 0.0;
};
/// For each member the strongest by the time, an angle, a position, a speed or a force. Near a
/// law's relative (friction that grows with the load, a spring that stiffens) it is large although
/// hardly anything is left. 0 for modes, whose ringing depends on motion that nobody sees.
std::vector<Modulation> modulations(const Setting& setting, const JointFit& fit);

/// What another mode on the axis of this one would explain beside the whole model: where it is
/// much, the one stands for several.
double second_mode(const Setting& setting, const JointFit& fit, const Member& mode);

}  // namespace dcnn
