// SPDX-License-Identifier: Apache-2.0
// The best of the dictionary along every direction, by one matrix product.
#pragma once

#include "discovery/refine.h"

namespace dcnn::discovery {

/// The `count` sketches of largest gain, at most two with the same direction and coordinates; gains
/// are exact, numbers those of the dictionary.
std::vector<Trial> scan(const Data& data, std::size_t count);

}  // namespace dcnn::discovery
