// SPDX-License-Identifier: Apache-2.0
// The functions of an LSTM's cell at one step (Hochreiter and Schmidhuber 1997, with the forget
// gate of Gers et al. 2000), and their derivatives.
#pragma once

#include "dcnn/core/tensor.h"

namespace dcnn {

/// Arrays are (rows, units), `gates` is (rows, 4·units): i | f | g | o side by side.
///   i, f, o = logistic, g = tanh of what `gates` holds, which they replace
///   c = f·c_before + i·g
///   h = o·tanh(c)
struct LstmCell {
  Index rows, units;
  Real* gates;
  const Real* c_before;  // null: zeros
  Real *c, *tanh_c;
  Real* h;
  Index h_row;  // from one row of h to the next
};
void lstm_cell(const LstmCell& cell);

/// Replaces `gates` by dLoss/d(what they were functions of), and dc, dLoss/dc as far as later steps
/// saw c, by dLoss/dc_before.
struct LstmCellGradient {
  Index rows, units;
  Real* gates;
  const Real* c_before;  // null: zeros
  const Real* tanh_c;
  const Real* dh;
  Real* dc;
};
void lstm_cell_gradient(const LstmCellGradient& cell);

}  // namespace dcnn
