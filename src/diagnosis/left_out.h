// SPDX-License-Identifier: Apache-2.0
// Whether a member of a model helps where it was not fitted.
#pragma once

#include "diagnosis/joint_fit.h"

namespace dcnn {

/// For each member, the share of its gain in chi-square that is left on pieces of time that the
/// model, linear about its fit, did not see: six pieces of each recording, left out in turn. Near 1
/// for a law, below 0 for what only follows these recordings.
std::vector<double> left_out_shares(const Setting& setting, const JointFit& fit);

/// The part of a recording, of kRecordingParts, that a time lies in.
constexpr int kRecordingParts = 6;
int part_of(const Motion& motion, double t);

}  // namespace dcnn
