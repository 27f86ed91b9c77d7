// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dcnn/core/tensor.h"

namespace dcnn {

/// Half mean squared error: 0.5·(sum over outputs of (predicted - wanted)^2), mean over the N samples
/// (Su et al. 2020). Both (N, outputs); the result has shape (1).
Tensor half_mean_squared_error(const Tensor& predicted, const Tensor& wanted);

}  // namespace dcnn
