// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/layer.h"

namespace dcnn {

#define LAYER(name) extern const LayerKind name;
#include "nn/layers.def"
#undef LAYER

std::vector<const LayerKind*> layer_kinds() {
  return {
#define LAYER(name) &name,
#include "nn/layers.def"
#undef LAYER
  };
}

}  // namespace dcnn
