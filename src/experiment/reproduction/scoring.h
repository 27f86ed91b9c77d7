// One evaluation of one model under one noise mode.
#pragma once

#include <filesystem>

#include "dcnn/experiment/evaluate.h"
#include "experiment/reproduction/plan.h"

namespace dcnn {

/// The mode's part of a request: draws, samples and how noise is put on.
EvaluationRequest scoring_request(const NoiseMode& mode);

/// Measured and predicted forces of the clean run as CSV: columns t, the targets, the targets with
/// `_hat`; evenly thinned to at most 4096 rows.
void write_trace(const std::filesystem::path& file, const Evaluation& evaluation);

/// The paper times every identifier but the absent one.
bool timed(const Entry& entry);

}  // namespace dcnn
