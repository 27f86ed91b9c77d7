// SPDX-License-Identifier: Apache-2.0
// What a sealed challenge came to, as text and as a page.
#pragma once

#include <filesystem>
#include <string>

#include "dcnn/core/json.h"

namespace dcnn {

/// `scores` as conceal::score_challenge makes them.
std::string challenge_text(const Json& scores);
std::string challenge_html(const Json& scores);

/// FOLDER/scores.json, FOLDER/report.html and its first figure, FOLDER/holdout.svg.
void write_challenge(const std::filesystem::path& folder, const Json& scores);

}  // namespace dcnn
