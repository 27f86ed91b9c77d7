// SPDX-License-Identifier: Apache-2.0
// A network is a list of layers, so it is data.
#pragma once

#include <string>
#include <vector>

#include "dcnn/nn/layer.h"

namespace dcnn {

/// Layers in sequence, built from JSON: [{"kind": "conv2d", "filters": 8, "window": [2, 2]}, …].
/// Every layer learns its input shape by passing one zero sample through those before it.
class Network {
 public:
  /// `input` is the shape of one sample (H, W, C). Unknown kinds and keys are Error(kUsage).
  Network(const Json& layers, const Shape& input, Rng& rng);

  /// x is (N, input…); the result (N, outputs).
  Tensor forward(const Tensor& x, Pass& pass) const;

  /// Whether processes can divide the pieces of a batch among them.
  bool is_divisible() const;

  /// Everything a model file holds, named "<index>.<kind>.<tensor>", in layer order.
  const std::vector<NamedTensor>& state() const { return state_; }
  /// Number of learnable parameters (statistics do not count).
  Index parameter_count() const;

  const Json& layers() const { return layers_; }
  const Shape& input() const { return input_; }
  /// Of one sample before each layer, and after the last one.
  const std::vector<Shape>& shapes() const { return shapes_; }

  /// The same function at inference with every batch norm folded into the convolution or the fully
  /// connected layer before it (y = (Wx + b - mean)·gamma/sqrt(var + eps) + beta).
  Network folded() const;

  /// folded() for one sample after another. Error(kUsage) where no layer can multiply in what is
  /// asked for.
  Plan plan(Precision precision = Precision::kSingle) const;

 private:
  Json layers_;
  Shape input_;
  std::vector<LayerPtr> stack_;
  std::vector<bool> absorbed_;  // of each layer: one before it does what it does
  std::vector<NamedTensor> state_;
  std::vector<Shape> shapes_;
};

}  // namespace dcnn
