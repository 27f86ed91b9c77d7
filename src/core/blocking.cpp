// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/blocking.h"

#include <Eigen/Dense>

namespace dcnn {

void fix_blocking() {
  constexpr std::ptrdiff_t kFirst = 32 * 1024, kSecond = 512 * 1024, kThird = 4096 * 1024;
  const bool fixed = Eigen::l1CacheSize() == kFirst && Eigen::l2CacheSize() == kSecond &&
                     Eigen::l3CacheSize() == kThird;
  if (!fixed) Eigen::setCpuCacheSizes(kFirst, kSecond, kThird);
}

namespace {

// Whatever of the library is called first.
[[maybe_unused]] const bool kIsFixed = (fix_blocking(), true);

}  // namespace

}  // namespace dcnn
