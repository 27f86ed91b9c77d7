// What a finished search found, and what it could not have found, as report.json has it.
#pragma once

#include "diagnosis/holdout.h"
#include "diagnosis/search.h"

namespace dcnn {

/// The findings, in the order of the model.
Json findings_json(const Search& search, const HoldOut& holdout);
/// What would have been named from which size on, and what these recordings cannot show.
void add_limits(const Search& search, const HoldOut& holdout, Json& report);

}  // namespace dcnn
