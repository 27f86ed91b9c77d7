// SPDX-License-Identifier: Apache-2.0
// What the text and the page of a sealed challenge share.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn {

using Columns = std::vector<std::pair<std::string, std::string>>;  // key, heading

/// "97 % [91, 99] of 40", or "1.002, 90 % below 1.02" (median); empty where there is nothing.
std::string score_text(const Json& value);

/// "nothing", or names one after the other.
std::string joined_names(const Json& names);

/// What was counted over all scenarios: words and value, without what there was none of.
std::vector<std::vector<std::string>> headline_rows(const Json& scores);

/// The diagnosis, what is measured by it, and the true law. (Nobody but the diagnosis speaks the
/// verdicts that are scored.)
Json beside_rivals(const Json& scores);
/// The complete diagnosis, and the same without one part each.
Json beside_ablations(const Json& scores);

}  // namespace dcnn
