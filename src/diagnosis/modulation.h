// Whether the strength of a member depends on what its law does not know of.
#pragma once

#include <vector>

#include "diagnosis/joint_fit.h"

namespace dcnn {

/// Gain of chi-square from which on a modulation refutes a law: four times the largest of some
/// thirty that noise makes.
constexpr double kModulated = 25.0;

/// For each member, what more of it would explain if its strength grew, or bent, with the time, an
/// angle, a position, a speed or a force: the most of these, beside the whole model, less what more
/// than one number gain by chance. Near a law's relative (friction that grows with the load, a
/// spring that stiffens) this is large although hardly anything is left. 0 for modes, whose ringing
/// depends on motion that nobody sees.
std::vector<double> modulations(const Setting& setting, const JointFit& fit);

}  // namespace dcnn
