// SPDX-License-Identifier: Apache-2.0
// What the paper leaves open and how it was decided (spec section 9): printed with every result.
#pragma once

#include <string>
#include <vector>

namespace dcnn {

struct Assumption {
  std::string id, open, decided;
  std::string evidence;  ///< "free", "inferred", "documented default"
};

std::vector<Assumption> assumptions();

}  // namespace dcnn
