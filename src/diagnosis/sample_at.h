// SPDX-License-Identifier: Apache-2.0
// Samples of a motion by time.
#pragma once

#include "dcnn/physics/motion.h"

namespace dcnn {

/// The sample of a motion nearest to a time [s], whatever gaps it has.
Eigen::Index sample_at(const Motion& motion, double t);

}  // namespace dcnn
