// SPDX-License-Identifier: Apache-2.0
// Training noise for models that see all rows at once.
#pragma once

#include <cstdint>

#include "dcnn/models/model.h"

namespace dcnn {

/// The samples once, each row with noise of one of the levels (protocol A): of every L
/// consecutive rows, L the number of levels, each level has one, in random order. Every level thus
/// sees the whole motion, and neither a stride nor a period of the motion can favour one. Rows
/// remain in time; the result has no pose_noise. With the single level clean it is the samples.
Samples augmented(const Samples& samples, const NoiseSpec& spec, const InputMap& map,
                  std::uint64_t seed);

}  // namespace dcnn
