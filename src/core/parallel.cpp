#include "dcnn/core/parallel.h"

#include <omp.h>

#include <algorithm>
#include <exception>

namespace dcnn {

Index piece_count(Index n) {
  constexpr Index kLargest = 13, kMultiple = 4;
  if (n < kMultiple) return std::min<Index>(n, 1);
  return kMultiple * ((n + kLargest * kMultiple - 1) / (kLargest * kMultiple));
}

void for_each_piece(Index count, const std::function<void(Index)>& work) {
  // What leaves a parallel region as an exception ends the program.
  std::exception_ptr thrown;
  Index thrown_by = count;
#pragma omp parallel for schedule(static) if (count > 1)
  for (Index k = 0; k < count; ++k) {
    try {
      work(k);
    } catch (...) {
#pragma omp critical(dcnn_thrown_by_a_piece)
      if (k < thrown_by) {
        thrown = std::current_exception();
        thrown_by = k;
      }
    }
  }
  if (thrown) std::rethrow_exception(thrown);
}

void set_threads(int threads) {
  if (threads > 0) omp_set_num_threads(threads);
}

int threads() { return omp_get_max_threads(); }

}  // namespace dcnn
