// SPDX-License-Identifier: Apache-2.0
// The numbers of every figure as CSV and JSON beside the report.
#pragma once

#include <filesystem>

#include "experiment/reproduction/claims.h"

namespace dcnn {

/// figures/noise_<mode>_<series>.csv|json, figures/table1.csv|json, figures/training_<series>.csv.
void write_tables(const OutputLayout& layout, const ReproductionPlan& plan, const Results& results);

Json to_json(const std::vector<Claim>& claims);

/// The scores' mean and SD per model and level.
Json to_json(const Scores& scores);

}  // namespace dcnn
