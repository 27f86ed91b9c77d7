// SPDX-License-Identifier: Apache-2.0
// One row times a matrix in panels.
#pragma once

#include "dcnn/core/tensor.h"

namespace dcnn {

/// out = start + a·b; b in panels of kPanelWidth columns, `panel_step` values from one to the next
/// (panels.h), of which the last one may be partly unused.
struct RowProduct {
  const Real* a;
  Index depth;
  const Real* b;
  Index panel_step, columns;
  const Real* start;  // null: zero; may be `out`
  Real* out;
};
constexpr Index kPanelWidth = 32;  // two vectors of the AVX-512 kernel

/// Adds in the order of tile_product(). Several panels at once: one row alone has too few sums in
/// two vectors to hide the latency of a multiply-add.
void row_product(const RowProduct& product);

}  // namespace dcnn
