// SPDX-License-Identifier: Apache-2.0
// In which state a cable or a sensor was when the recordings began.
#pragma once

#include "diagnosis/joint_fit.h"
#include "diagnosis/scan.h"

namespace dcnn {

/// Whether nobody knows the effect's state when a recording begins: of a machine's load, which its
/// own drive makes, that of cables alone.
bool begins_anywhere(const Case& study, const Member& member);

/// Whitened columns, one a recording, of what another state of the effect at its first sample
/// changes: of a hysteresis it decays as exp(-way/width) with the way of the angle, of a creep as
/// exp(-t/tau) of the load at first. None for other effects.
Eigen::MatrixXd beginnings(const Setting& setting, const Member& member, Detail detail);

}  // namespace dcnn
