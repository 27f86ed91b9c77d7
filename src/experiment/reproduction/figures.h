// SPDX-License-Identifier: Apache-2.0
// The charts of the report.
#pragma once

#include <vector>

#include "dcnn/experiment/report.h"
#include "experiment/reproduction/results.h"

namespace dcnn {

/// Fig. 5 (a) to (d): RMSE of each target and overall over the noise levels, ±1 SD over draws, the
/// entries side by side; NS as a line.
std::vector<Chart> error_panels(const Scores& scores, const std::vector<Entry>& entries);

/// Mean validation RMSE over epochs of every model that has any, and training losses.
std::vector<Chart> training_panels(const OutputLayout& layout, const std::string& series,
                                   const std::vector<Entry>& entries);

/// Measured and predicted over 20 s in the middle of the test recording, one chart a target.
std::vector<Chart> trace_panels(const Results& results, const Scores& scores,
                                const std::vector<Entry>& entries);

/// How measured - predicted is spread, one chart a target.
std::vector<Chart> residual_panels(const Results& results, const Scores& scores,
                                   const std::vector<Entry>& entries);

/// Time per call over the length.
Chart timing_chart(const std::vector<Timing>& timings, const std::vector<Entry>& entries);

std::string label_of(const std::vector<Entry>& entries, const std::string& name);

}  // namespace dcnn
