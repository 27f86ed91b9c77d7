// SPDX-License-Identifier: Apache-2.0
// Recordings to judge by are none of those that were learned from.
#pragma once

#include <filesystem>
#include <vector>

namespace dcnn {

/// Error(kUsage) where a recording or a copy of one is named twice, to be learned from or judged
/// by: an error on rows that were fitted is no error on new data.
void expect_apart(const std::vector<std::filesystem::path>& learned,
                  const std::vector<std::filesystem::path>& judged);

}  // namespace dcnn
