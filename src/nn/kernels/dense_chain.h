// SPDX-License-Identifier: Apache-2.0
// Small fully connected layers one behind another, at inference.
#pragma once

#include <vector>

#include "dcnn/core/tensor.h"

namespace dcnn {

enum class Activation { kNone, kRelu, kTanh };

struct DenseLayer {
  static constexpr Index kMost = 64;  ///< inputs and outputs
  static constexpr Index kPad = 16;   ///< lanes of the widest vector

  /// weight (outputs, inputs) and bias (outputs), at most kMost of each.
  DenseLayer(const Tensor& weight, const Tensor& bias);

  Index inputs, outputs, padded;  ///< outputs, and those rounded up to whole vectors
  const Real *weights, *bias;     ///< (inputs, padded) and (padded), zeros behind
  Activation activation = Activation::kNone;
  Tensor memory;  ///< of both
};

/// y (outputs) of x (inputs): units in the vectors' lanes.
void dense_of_one(const std::vector<DenseLayer>& layers, const Real* x, Real* y);

/// y (n, outputs) of x (n, inputs): samples in the vectors' lanes. What a sample gives does not
/// depend on the others.
void dense_of_many(const std::vector<DenseLayer>& layers, const Real* x, Index n, Real* y);

}  // namespace dcnn
