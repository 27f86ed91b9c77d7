// SPDX-License-Identifier: Apache-2.0
// Whether a law may be believed: coloured residuals, held-out folds, blocks of time.
#pragma once

#include "discovery/refine.h"

namespace dcnn::discovery {

/// The law of a trial with its deviations and what speaks for it; not yet its rivals.
Discovered judged(const Data& data, const Trial& trial);

/// Above the acceptance level, and gaining on folds that it was not fitted to.
bool is_accepted(const Discovered& found);

}  // namespace dcnn::discovery
