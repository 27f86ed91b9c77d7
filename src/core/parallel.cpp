#include "dcnn/core/parallel.h"

#include <omp.h>

#include <algorithm>

namespace dcnn {

Index piece_count(Index n) {
  constexpr Index kLargest = 13, kMultiple = 4;
  if (n < kMultiple) return std::min<Index>(n, 1);
  return kMultiple * ((n + kLargest * kMultiple - 1) / (kLargest * kMultiple));
}

void for_each_piece(Index count, const std::function<void(Index)>& work) {
#pragma omp parallel for schedule(static) if (count > 1)
  for (Index k = 0; k < count; ++k) work(k);
}

void set_threads(int threads) {
  if (threads > 0) omp_set_num_threads(threads);
}

int threads() { return omp_get_max_threads(); }

}  // namespace dcnn
