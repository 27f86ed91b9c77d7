// SPDX-License-Identifier: Apache-2.0
// What a training refuses or says of its recordings before it learns from them.
#pragma once

#include <vector>

#include "dcnn/experiment/train.h"

namespace dcnn {

/// Error(kData) where nothing can be learned: every measured column, or the whole motion, is one
/// and the same number in all rows. A note for each target that is, and where the pose does not
/// move beyond its own noise.
void check_training(const std::vector<Recording>& recordings, const Targets& targets,
                    const System& system, const TrainingObserver& observer);

/// Whether a log has times; one without is a list of poses at rest, from which not every model
/// learns.
bool has_time(const Table& table);

}  // namespace dcnn
