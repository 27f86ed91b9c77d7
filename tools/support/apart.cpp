// SPDX-License-Identifier: Apache-2.0
#include "support/apart.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "dcnn/core/error.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

/// Of files that can be read twice; false where either cannot be read.
bool have_same_bytes(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  if (!fs::is_regular_file(a, missing) || !fs::is_regular_file(b, missing)) return false;
  if (fs::file_size(a, missing) != fs::file_size(b, missing) || missing) return false;
  std::ifstream first(a, std::ios::binary), second(b, std::ios::binary);
  if (!first || !second) return false;
  using Bytes = std::istreambuf_iterator<char>;
  return std::equal(Bytes(first), Bytes(), Bytes(second), Bytes());
}

bool are_same(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  return fs::equivalent(a, b, missing) || have_same_bytes(a, b);
}

}  // namespace

void expect_apart(const std::vector<fs::path>& learned, const std::vector<fs::path>& judged) {
  std::vector<fs::path> all = learned;
  all.insert(all.end(), judged.begin(), judged.end());
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      if (!are_same(all[j], all[k])) continue;
      std::error_code missing;
      const bool copied = !fs::equivalent(all[j], all[k], missing);
      const bool both = j < learned.size() && k >= learned.size();
      fail(Exit::kUsage, all[k].string(),
           copied ? ": is a copy of " + all[j].string() + ", so it" : ":",
           both ? " is learned from and judged by, but the error on rows that were fitted is no "
                  "error on new data; name another recording"
                : " is named twice; name it once");
    }
  }
}

}  // namespace dcnn
