// SPDX-License-Identifier: Apache-2.0
// The report of a reproduction: one HTML file.
#pragma once

#include <string>

#include "experiment/reproduction/claims.h"

namespace dcnn {

/// What every number of the page depends on, for its last table.
struct Conditions {
  std::vector<std::vector<std::string>> rows;  ///< name and value
};

struct Verdicts {
  std::string series;  ///< "A: all", "B: none", "only dcnn": what was trained with noise
  std::vector<Claim> claims;
};

std::string reproduction_page(const ReproductionRequest& request, const ReproductionPlan& plan,
                              const Results& results, const std::vector<Verdicts>& verdicts,
                              const Conditions& provenance);

}  // namespace dcnn
