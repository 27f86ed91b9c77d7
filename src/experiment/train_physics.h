// SPDX-License-Identifier: Apache-2.0
// The physical model among those that --model auto tries.
#pragma once

#include <optional>

#include "dcnn/experiment/train.h"

namespace dcnn {

/// Whether the recordings allow it: a tool on a wrist, in motion, without --online, which asks for
/// limits that only models with features of their own learn.
bool can_be_physics(const TrainingRequest& request);

/// Identifies the tool from the training rows, or takes request.base, corrects it by what a
/// diagnosis of these rows finds, and writes the corrected simulator as a model to `request.out`.
/// The validation rows decide nothing. Not finished where observer.stop_wanted() says so, which is
/// asked all along. Simulators and rows are kept in `folder`.
TrainingOutcome train_physics(const TrainingRequest& request, const std::filesystem::path& folder,
                              const TrainingObserver& observer);

}  // namespace dcnn
