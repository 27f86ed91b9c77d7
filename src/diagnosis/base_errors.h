// SPDX-License-Identifier: Apache-2.0
// How a base simulator that is known may be off.
#pragma once

#include "diagnosis/case.h"

namespace dcnn {

/// What errors of a known base make of the reading, a standard deviation each, low-passed as the
/// case is; none where the base is fitted or nobody knows its errors.
std::vector<Signals> base_errors(const Case& study);

}  // namespace dcnn
