// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/layer.h"

namespace dcnn {
namespace {

/// (N, …) to (N, product): of an image, feature (row·W + column)·C + channel.
class Flatten final : public Layer {
 public:
  Tensor forward(const Tensor& x, Pass&) const override {
    return x.reshaped({x.dim(0), x.size() / x.dim(0)});
  }
  std::unique_ptr<PlanStep> plan(const Shape&, PlanStep*) const override { return nullptr; }
};

LayerPtr make_flatten(Options&, const Shape&, Rng&) { return std::make_unique<Flatten>(); }

}  // namespace

extern constinit const LayerKind flatten{
    .name = "flatten", .example = "{}", .example_input = {3, 4, 2, 5}, .make = make_flatten};

}  // namespace dcnn
