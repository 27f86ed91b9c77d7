// Computation time of one identifier (spec 5.2).
#pragma once

#include <functional>

#include "dcnn/models/identifier.h"
#include "experiment/reproduction/ledger.h"
#include "experiment/reproduction/plan.h"

namespace dcnn {

/// Predicts the recording's feature vectors in consecutive calls of 1, 5 and 10 samples on one
/// pinned thread, after a warm-up. A call begins with the features and ends with the forces.
/// Returns
/// {"threads", "rows": [...]} as in contract.md section 5.
Json time_calls(const Identifier& identifier, const Recording& recording, Index samples,
                int repetitions, const StepSession& session);

}  // namespace dcnn
