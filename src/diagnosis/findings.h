// SPDX-License-Identifier: Apache-2.0
// What a finished search found, and what it could not have found, as report.json has it.
#pragma once

#include "diagnosis/holdout.h"
#include "diagnosis/search.h"

namespace dcnn {

/// The findings, in the order of the model, with Search::alternatives(), beside the noise of the
/// held-out recordings. `open`: beside them something remains that none of them explains. Each is
/// then as probable as the share of it that it explains allows (HoldOut::share_explained()): of
/// what has no name, every law explains a part.
Json findings_json(const Search& search, const HoldOut& holdout,
                   const std::vector<std::vector<Alternative>>& alternatives,
                   const std::vector<Floor>& noise, bool open);
/// The models that the recordings cannot exclude beside the one chosen, alternatives and subsets of
/// the names: their effects as model.json has them, the log of their odds against the chosen, their
/// chi-square above it, and how many numbers more they have.
Json rivals_json(const Search& search, const std::vector<std::vector<Alternative>>& alternatives);
/// What would have been named from which size on, and what these recordings cannot show.
void add_limits(const Search& search, const HoldOut& holdout, Json& report);

}  // namespace dcnn
