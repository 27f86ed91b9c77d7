// SPDX-License-Identifier: Apache-2.0
// Work on the rows of a recording that do not depend on one another.
#pragma once

#include <algorithm>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// Calls work(i) for i in [0, rows), blocks of rows on the threads.
template <class Work>
void for_each_row(Index rows, const Work& work) {
  constexpr Index kBlock = 4096;
  for_each_piece((rows + kBlock - 1) / kBlock, [&](Index k) {
    const Index end = std::min(rows, (k + 1) * kBlock);
    for (Index i = k * kBlock; i < end; ++i) work(i);
  });
}

}  // namespace dcnn
