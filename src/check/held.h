// SPDX-License-Identifier: Apache-2.0
// Values that a slower source holds from one row to the next.
#pragma once

#include "check/rows.h"

namespace dcnn::check {

struct Held {
  Eigen::Index length = 1;   ///< rows for which a value is held
  double probability = 0.0;  ///< of the fault
};

/// Of columns that one source brings together.
Held held_of(const Log& log, const std::vector<std::string>& names);

}  // namespace dcnn::check
