// SPDX-License-Identifier: Apache-2.0
// A finding of report.json in words, for the page and the terminal.
#pragma once

#include <string>
#include <vector>

#include "core/lists.h"
#include "dcnn/core/json.h"

namespace dcnn {

/// A text as it is, nothing for null, anything else as JSON.
std::string plain_text(const Json& value);

/// "along the tool", "from 12.3 to 14.0 s of fit.csv", or both.
std::string place_in_words(const Json& finding);
/// "friction force: 0.4 N (0.398 to 0.401)", one for each number.
std::vector<std::string> numbers_in_words(const Json& finding);
/// "cable with Bouc-Wen hysteresis over one coordinate (30 %)", one for each alternative.
std::vector<std::string> alternatives_in_words(const Json& finding);
/// Whether the search ended at its limit and something remains.
bool remains_untried(const Json& report);
/// "partly explained" for "partly-explained".
std::string verdict_in_words(std::string verdict);
/// "to tell dry friction from linear friction", of next_motion.
std::string question_in_words(const Json& next_motion);

}  // namespace dcnn
