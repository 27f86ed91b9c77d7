// SPDX-License-Identifier: Apache-2.0
// The tables of the report.
#pragma once

#include <vector>

#include "dcnn/experiment/report.h"
#include "experiment/reproduction/page.h"

namespace dcnn {

/// Claims against readings, then the numbers of each; not `judged`: the numbers alone count.
void add_claim_table(HtmlReport& page, const std::vector<Verdicts>& verdicts, bool judged);
/// Overall RMSE per model and level.
void add_overall_table(HtmlReport& page, const Scores& scores, const std::vector<Entry>& entries);
/// Overall RMSE per model and level, then per target.
void add_score_table(HtmlReport& page, const Scores& scores, const std::vector<Entry>& entries);
/// Table I with the paper's columns beside ours.
void add_timing_table(HtmlReport& page, const std::vector<Timing>& timings,
                      const ReproductionPlan& plan);
/// Mean and SD over further trainings of the overall RMSE.
void add_training_spread(HtmlReport& page, const ReproductionPlan& plan, const Results& results);

}  // namespace dcnn
