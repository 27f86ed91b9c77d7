// SPDX-License-Identifier: Apache-2.0
// The steps of an LSTM over the samples of one piece, there and back.
#pragma once

#include "dcnn/core/tensor.h"
#include "nn/kernels/panels.h"

namespace dcnn {

struct LstmShape {
  Index steps, inputs, units;
  bool sequence;  // h of every step, not of the newest alone

  Index joined() const { return inputs + units; }
  Index gates() const { return 4 * units; }
  Index outputs() const { return sequence ? steps * units : units; }
};

/// What the steps of `samples` samples leave for the way back, or the last two of them where there
/// is none. Arrays are (kept steps, samples, width): a step is one matrix, and so are all together.
struct LstmTrace {
  LstmShape shape;
  Index samples, kept;
  Real* joined;  // x_t | h_(t-1)
  Real *gates, *c, *tanh_c;

  /// To go back, one step more than there are: its `joined` holds the newest h alone.
  static Index kept_steps(const LstmShape& s, bool to_go_back) {
    return to_go_back ? s.steps + 1 : 2;
  }
  /// Numbers for each sample.
  static Index size(const LstmShape& s, Index kept) {
    return kept * (s.joined() + s.gates() + 2 * s.units);
  }
  LstmTrace(const LstmShape& s, Index n, Index its_kept, Real* memory)
      : shape(s),
        samples(n),
        kept(its_kept),
        joined(memory),
        gates(joined + kept * n * s.joined()),
        c(gates + kept * n * s.gates()),
        tanh_c(c + kept * n * s.units) {}

  Real* joined_at(Index t) const { return joined + t % kept * samples * shape.joined(); }
  Real* gates_at(Index t) const { return gates + t % kept * samples * shape.gates(); }
  Real* tanh_c_at(Index t) const { return tanh_c + t % kept * samples * shape.units; }
  Real* c_at(Index t) const { return t < 0 ? nullptr : c + t % kept * samples * shape.units; }
};

/// Fills the trace from x (samples, T, F) and y, the layer's output. `weights` is (F + H, 4H): both
/// weights, one above the other, as factors of x_t | h_(t-1); `bias` is (4H).
void run_lstm(const LstmTrace& trace, const Panels& weights, const Real* bias, const Real* x,
              Real* y);

/// Back through time (Werbos 1990): turns the gates of every step into dLoss/d(their arguments).
/// `recurrent` is (4H, H), the transposed recurrent weight; dy as the layer's output.
void run_lstm_back(const LstmTrace& trace, const Panels& recurrent, const Real* dy);

/// After run_lstm_back(): adds xᵀ·(gradients of the gates' arguments) to `input` (F, 4H), and the
/// same with h of the step before to `recurrent` (H, 4H), which one step alone does not touch.
void add_weight_gradients(const LstmTrace& trace, Real* input, Real* recurrent);

/// After run_lstm_back(): writes or adds dLoss/dx (samples, T, F). `input` is (4H, F), the
/// transposed input weight.
void put_input_gradient(const LstmTrace& trace, const Panels& input, Tensor::GradientSlot dx);

}  // namespace dcnn
