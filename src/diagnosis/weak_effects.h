// SPDX-License-Identifier: Apache-2.0
// Effects too faint for the fitted poses alone, which held-out poses bear out.
#pragma once

#include "diagnosis/holdout.h"
#include "diagnosis/search.h"

namespace dcnn {

/// Of poses at rest, which are few, where nothing was found and nothing remains: adds the name that
/// is likeliest by evidence of the fitted rows and support of the held-out ones together, if it is
/// likelier than none. (A recording in motion has rows enough: what it does not show by itself was
/// a false name where noise grew with the speed.)
void add_weak_effects(Search& search, const HoldOut& holdout);

}  // namespace dcnn
