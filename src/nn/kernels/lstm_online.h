// SPDX-License-Identifier: Apache-2.0
// The functions of an LSTM's cell where nothing is kept for a way back (lstm_cell.h).
#pragma once

#include "dcnn/core/tensor.h"

namespace dcnn {

/// `gates`, at steps of gates_row: i | f | g | o side by side, `units` each, before their
/// functions. c and h, at steps of `row`: of the step before and then of this one. Whole vectors
/// are read and written, as units one by one would cost as much as the vectors: all three arrays
/// have kSlack values after their last unit, where the result means nothing.
struct LstmOnline {
  static constexpr Index kSlack = 16;
  Index rows, units;
  const Real* gates;
  Index gates_row;
  Real *c, *h;
  Index row;
};

/// What lstm_cell() computes, to some 1e-7: fractions of one step share a denominator, which is
/// two divisions instead of five.
void lstm_online(const LstmOnline& cell);

}  // namespace dcnn
