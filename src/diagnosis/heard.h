// SPDX-License-Identifier: Apache-2.0
// Effects that detectors found (detectors.h, impacts.h), judged by held-out data.
#pragma once

#include <optional>

#include "diagnosis/holdout.h"

namespace dcnn {

/// A hum whose phase does not last to the held-out data predicts nothing there: it is noise, whose
/// floor holds it. Its frequency [Hz] where there is one.
std::optional<double> take_hum_for_noise(Search& search, const HoldOut& holdout);

/// Removes a loose load from the model where the Bayes factor of its impacts on held-out recordings
/// is below 1: that finding, as one that was refuted.
Json leave_refuted_impacts(Search& search, const HoldOut& holdout);

}  // namespace dcnn
