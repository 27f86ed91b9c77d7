// SPDX-License-Identifier: Apache-2.0
// The network of the paper, for tests and benchmarks.
#pragma once

#include <string>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn {

inline Json dcnn_layers(const std::string& padding,
                        const std::vector<int>& filters = {8, 16, 32, 32}) {
  Json layers = Json::array();
  for (const int count : filters) {
    layers.push_back({{"kind", "conv2d"}, {"filters", count}, {"padding", padding}});
    layers.push_back({{"kind", "batch_norm"}});
    layers.push_back({{"kind", "relu"}});
  }
  layers.push_back({{"kind", "dropout"}, {"rate", 0.5}});
  layers.push_back({{"kind", "flatten"}});
  layers.push_back({{"kind", "linear"}, {"outputs", 3}});
  return layers;
}

}  // namespace dcnn
