// SPDX-License-Identifier: Apache-2.0
// Names of files for messages and reports.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dcnn {

/// The name of a file, with as many of its folders before it as tell it from others of that name
/// in the list: run1/log.csv beside run2/log.csv.
std::string distinct_name(const std::filesystem::path& file,
                          const std::vector<std::filesystem::path>& list);

}  // namespace dcnn
