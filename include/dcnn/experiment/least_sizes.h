// SPDX-License-Identifier: Apache-2.0
// From which size on an effect that was not found would have been, in its own unit.
#pragma once

#include "dcnn/diagnosis/diagnose.h"

namespace dcnn {

/// Adds `least` ({"parameter", "value", "unit"}) to the entries of `not_detected` of a wrist tool:
/// the size at which the effect adds `minimum_detectable_rms` to the channel that shows it most, on
/// the motion of the first recording. Effects are taken along the axis that shows them least, their
/// shapes as in the catalogue's example. Entries whose effect has no size of its own, and those of
/// other machines, stay without it.
void add_least_sizes(const DiagnosisRequest& request, Diagnosis& diagnosis);

}  // namespace dcnn
