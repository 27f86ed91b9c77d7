// SPDX-License-Identifier: Apache-2.0
// Matrix products that are the same on every processor.
#pragma once

namespace dcnn {

/// Eigen cuts products into blocks that fit the caches of the processor, so that sums would differ
/// in their last bits from one processor to the next. From here on it takes caches of 32 KB, 512 KB
/// and 4 MB everywhere. Called where the library is loaded, by every tool, by simulate_config() and
/// by diagnose(); to be called while no other thread multiplies.
void fix_blocking();

}  // namespace dcnn
