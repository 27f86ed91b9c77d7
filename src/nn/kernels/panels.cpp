// SPDX-License-Identifier: Apache-2.0
#include "nn/kernels/panels.h"

#include <algorithm>

#include "nn/kernels/tile.h"

namespace dcnn {

Panels::Panels(Index rows, Index columns)
    : rows_(rows), columns_(columns), values_(Tensor::uninitialised({count(), rows, kWidth})) {}

void Panels::set(Index first, Index count_of_rows, const Real* from, Index row_step,
                 Index column_step) {
  for_each_piece(count(), [&](Index p) {
    const Index begin = p * kWidth, width = std::min(kWidth, columns_ - begin);
    for (Index k = 0; k < count_of_rows; ++k) {
      const Real* row = from + k * row_step + begin * column_step;
      Real* to = panel(p) + (first + k) * kWidth;
      for (Index c = 0; c < width; ++c) to[c] = row[c * column_step];
      std::fill(to + width, to + kWidth, Real(0));  // multiplied by row_product(), to no effect
    }
  });
}

void Panels::multiply(const Product& product) const {
  const Index columns = product.padded ? padded_columns() : columns_;
  if (product.rows == 1) {
    return row_product({product.a, product.depth, panel(0) + product.first * kWidth, rows_ * kWidth,
                        columns, product.start, product.out});
  }
  const Run run{0, 0, product.depth};
  for (Index p = 0; p < count(); ++p) {
    const Index begin = p * kWidth;
    tile_product({.a = product.a,
                  .a_row = product.a_row,
                  .a_step = 1,
                  .b = panel(p) + product.first * kWidth,
                  .b_step = kWidth,
                  .runs = {&run, 1},
                  .out = product.out + begin,
                  .out_row = product.out_row,
                  .start = product.start ? product.start + begin : nullptr,
                  .start_row = product.start_row,
                  .rows = product.rows,
                  .columns = std::min(kWidth, columns - begin)});
  }
}

}  // namespace dcnn
