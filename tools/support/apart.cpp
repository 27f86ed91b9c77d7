#include "support/apart.h"

#include "dcnn/core/error.h"

namespace dcnn {

void expect_apart(const std::vector<std::filesystem::path>& learned,
                  const std::vector<std::filesystem::path>& judged) {
  std::vector<std::filesystem::path> all = learned;
  all.insert(all.end(), judged.begin(), judged.end());
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      std::error_code missing;
      if (!std::filesystem::equivalent(all[j], all[k], missing)) continue;
      const bool both = j < learned.size() && k >= learned.size();
      fail(Exit::kUsage, all[k].string(),
           both ? ": is learned from and judged by, but the error on rows that were fitted is no "
                  "error on new data; name another recording"
                : ": is named twice; name it once");
    }
  }
}

}  // namespace dcnn
