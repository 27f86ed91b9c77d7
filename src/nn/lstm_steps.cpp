// SPDX-License-Identifier: Apache-2.0
#include "nn/lstm_steps.h"

#include <algorithm>

#include "nn/kernels/lstm_cell.h"
#include "nn/kernels/tile.h"

namespace dcnn {

void run_lstm(const LstmTrace& trace, const Panels& weights, const Real* bias, const Real* x,
              Real* y) {
  const LstmShape& s = trace.shape;
  for (Index t = 0; t < s.steps; ++t) {
    Real* joined = trace.joined_at(t);
    for (Index n = 0; n < trace.samples; ++n) {
      std::copy_n(x + (n * s.steps + t) * s.inputs, s.inputs, joined + n * s.joined());
    }
    weights.multiply({.a = joined,
                      .a_row = s.joined(),
                      .rows = trace.samples,
                      .depth = t > 0 ? s.joined() : s.inputs,
                      .out = trace.gates_at(t),
                      .out_row = s.gates(),
                      .start = bias,
                      .start_row = 0});
    lstm_cell({.rows = trace.samples,
               .units = s.units,
               .gates = trace.gates_at(t),
               .c_before = trace.c_at(t - 1),
               .c = trace.c_at(t),
               .tanh_c = trace.tanh_c_at(t),
               .h = trace.joined_at(t + 1) + s.inputs,
               .h_row = s.joined()});
    if (!s.sequence && t + 1 < s.steps) continue;
    const Real* h = trace.joined_at(t + 1) + s.inputs;
    for (Index n = 0; n < trace.samples; ++n) {
      std::copy_n(h + n * s.joined(), s.units,
                  y + n * s.outputs() + (s.sequence ? t * s.units : 0));
    }
  }
}

void run_lstm_back(const LstmTrace& trace, const Panels& recurrent, const Real* dy) {
  const LstmShape& s = trace.shape;
  Tensor dh({trace.samples, s.units}), dc({trace.samples, s.units});
  for (Index t = s.steps - 1; t >= 0; --t) {
    if (s.sequence || t == s.steps - 1) {
      const Real* from = dy + (s.sequence ? t * s.units : 0);
      for (Index n = 0; n < trace.samples; ++n) {
        for (Index k = 0; k < s.units; ++k) dh.data()[n * s.units + k] += from[n * s.outputs() + k];
      }
    }
    lstm_cell_gradient({.rows = trace.samples,
                        .units = s.units,
                        .gates = trace.gates_at(t),
                        .c_before = trace.c_at(t - 1),
                        .tanh_c = trace.tanh_c_at(t),
                        .dh = dh.data(),
                        .dc = dc.data()});
    if (t == 0) return;
    recurrent.multiply({.a = trace.gates_at(t),
                        .a_row = s.gates(),
                        .rows = trace.samples,
                        .depth = s.gates(),
                        .out = dh.data(),
                        .out_row = s.units,
                        .start = nullptr,
                        .start_row = 0});
  }
}

void add_weight_gradients(const LstmTrace& trace, Real* input, Real* recurrent) {
  const LstmShape& s = trace.shape;
  // Of some 64 rows, the tiles' share of both factors stays in the nearest cache.
  const Index some_steps = std::max<Index>(1, 64 / trace.samples);
  const auto add = [&](Index first, Index end, const Real* a, Index rows, Real* to) {
    const Run run{0, 0, (end - first) * trace.samples};
    tile_product({.a = a,
                  .a_row = 1,
                  .a_step = s.joined(),
                  .b = trace.gates_at(first),
                  .b_step = s.gates(),
                  .runs = {&run, 1},
                  .out = to,
                  .out_row = s.gates(),
                  .start = to,
                  .start_row = s.gates(),
                  .rows = rows,
                  .columns = s.gates()});
  };
  for (Index t = 0; t < s.steps; t += some_steps) {
    const Index end = std::min(s.steps, t + some_steps), second = std::max<Index>(t, 1);
    add(t, end, trace.joined_at(t), s.inputs, input);
    if (second < end) add(second, end, trace.joined_at(second) + s.inputs, s.units, recurrent);
  }
}

void put_input_gradient(const LstmTrace& trace, const Panels& input, Tensor::GradientSlot dx) {
  const LstmShape& s = trace.shape;
  for (Index t = 0; t < s.steps; ++t) {
    Real* to = dx.data + t * s.inputs;
    input.multiply({.a = trace.gates_at(t),
                    .a_row = s.gates(),
                    .rows = trace.samples,
                    .depth = s.gates(),
                    .out = to,
                    .out_row = s.steps * s.inputs,
                    .start = dx.add ? to : nullptr,
                    .start_row = s.steps * s.inputs});
  }
}

}  // namespace dcnn
