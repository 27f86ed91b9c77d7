// SPDX-License-Identifier: Apache-2.0
// Lists of numbers in JSON and of words in a line.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn {

inline Json json_list(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return std::vector<double>(values.begin(), values.end());
}

/// "a, b" of a and b.
inline std::string joined(const std::vector<std::string>& words,
                          const std::string& between = ", ") {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k) text += (k == 0 ? "" : between) + words[k];
  return text;
}

}  // namespace dcnn
