// SPDX-License-Identifier: Apache-2.0
// What dcnn-check writes: check.json and check.html.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/check/check.h"

namespace dcnn {

/// One document for all logs: `faults` of each with its `log`, `identifiable` by any, `logs`.
Json check_json(const std::vector<check::Report>& reports);

/// The page: what is wrong and what mends it, then the pictures that show it.
std::string check_html(const std::vector<check::Report>& reports);

/// FOLDER/check.json and FOLDER/check.html.
void write_check(const std::filesystem::path& folder, const std::vector<check::Report>& reports);

}  // namespace dcnn
