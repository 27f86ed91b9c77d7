// Held-out data on what was found by tests of its own: a hum above the motion's band, knocks.
#pragma once

#include <optional>

#include "diagnosis/holdout.h"

namespace dcnn {

/// A hum whose phase does not last to the held-out data predicts nothing there: it is noise, whose
/// floor holds it. Its frequency [Hz] where there is one.
std::optional<double> take_hum_for_noise(Search& search, const HoldOut& holdout);

/// Takes back knocks that recordings of their own show less likely than none; as findings that were
/// refuted.
Json leave_refuted_knocks(Search& search, const HoldOut& holdout);

}  // namespace dcnn
