// SPDX-License-Identifier: Apache-2.0
// What a diagnosis has computed, counted the same for any number of threads.
#pragma once

#include <atomic>
#include <cstdint>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// Samples that were predicted, once for each effect that acts on them and once for the tool.
class Work {
 public:
  void add(Index samples, std::size_t effects) {
    samples_.fetch_add(static_cast<std::uint64_t>(samples) * (1 + effects),
                       std::memory_order_relaxed);
  }
  std::uint64_t samples() const { return samples_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> samples_{0};
};

}  // namespace dcnn
