// SPDX-License-Identifier: Apache-2.0
// Which level of noise each training row has.
#pragma once

#include <cstdint>
#include <vector>

#include "dcnn/models/model.h"

namespace dcnn {

/// Index into NoiseSpec::levels of each row, one draw for every NoiseSpec::block_rows rows of a
/// segment: what noisy_blocks() with the same key adds.
std::vector<std::size_t> block_levels(const Samples& samples, const NoiseSpec& spec,
                                      std::uint64_t key);

}  // namespace dcnn
