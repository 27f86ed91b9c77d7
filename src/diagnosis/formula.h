// SPDX-License-Identifier: Apache-2.0
// Polynomial terms in what no effect of the catalogue explains.
#pragma once

#include "diagnosis/joint_fit.h"

namespace dcnn {

/// The largest gain of one term along one axis of sensor or base, in what a fit leaves: powers and
/// products of two of position, orientation, their rates, predicted force and time, and signs of
/// rates; some 15 where only noise is left, for the best of thousands.
double most_of_a_term(const Setting& setting, const JointFit& fit);

}  // namespace dcnn
