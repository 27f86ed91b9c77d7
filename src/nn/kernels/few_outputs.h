// A fully connected layer of few outputs for one sample.
#pragma once

#include "dcnn/core/tensor.h"

namespace dcnn {

/// y = bias + weights·x, weights (outputs, inputs). Four sums for each output hide the latency that
/// affine() has with three outputs; it adds in another order.
void few_outputs(const Real* x, const Real* weights, const Real* bias, Index inputs, Index outputs,
                 Real* y);

}  // namespace dcnn
