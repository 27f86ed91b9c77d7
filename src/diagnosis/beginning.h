// How a cable was bent when the recordings began.
#pragma once

#include "diagnosis/joint_fit.h"
#include "diagnosis/scan.h"

namespace dcnn {

/// Whitened columns, one a recording, of what another state of a hysteresis at its first sample
/// changes: it decays as exp(-way/width) with the way of the angle. None for other effects.
Eigen::MatrixXd beginnings(const Setting& setting, const Member& member, Detail detail);

}  // namespace dcnn
