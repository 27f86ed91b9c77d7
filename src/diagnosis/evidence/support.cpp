#include "diagnosis/evidence/support.h"

#include <algorithm>

namespace dcnn::evidence {

double log_support(const std::vector<BlockChange>& blocks) {
  BlockChange all;
  for (const BlockChange& block : blocks) all.fall += block.fall, all.apart += block.apart;
  if (blocks.size() < 2 || all.apart <= 0.0) return 0.0;
  double square = 0.0;  // of each block's fall about what its share of `apart` would make of it
  for (const BlockChange& block : blocks) {
    const double off = block.fall - block.apart * all.fall / all.apart;
    square += off * off;
  }
  const auto n = static_cast<double>(blocks.size());
  const double variance = square * n / (n - 1.0);
  return 0.5 * all.fall / std::max(1.0, variance / (4.0 * all.apart));
}

}  // namespace dcnn::evidence
