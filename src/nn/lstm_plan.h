// SPDX-License-Identifier: Apache-2.0
// An LSTM as a step of a plan (dcnn/nn/plan.h).
#pragma once

#include <memory>

#include "dcnn/nn/plan.h"
#include "nn/lstm_steps.h"

namespace dcnn {

/// `weights` and `bias` as run_lstm() has them.
std::unique_ptr<PlanStep> make_lstm_step(const LstmShape& shape, Panels weights,
                                         const Tensor& bias);

}  // namespace dcnn
