// SPDX-License-Identifier: Apache-2.0
// A matrix cut into panels of columns, for products that meet it many times.
#pragma once

#include "nn/kernels/row_product.h"

namespace dcnn {

/// The right factor b (rows, columns) of out = start + a·b. Where b is some hundred kilobytes, its
/// rows lie kilobytes apart and every tile would wait for the cache; a panel of kWidth columns is
/// one stretch of memory.
class Panels {
 public:
  static constexpr Index kWidth = kPanelWidth;

  Panels(Index rows, Index columns);
  /// Sets `count` rows from `first` on: b[first + k, c] = from[k·row_step + c·column_step].
  void set(Index first, Index count, const Real* from, Index row_step, Index column_step);

  /// Left factor and result of a product; rows of `a` and `out` at steps of a_row and out_row.
  struct Product {
    const Real* a;
    Index a_row, rows;
    Index depth;  // rows of b, and columns of a, that take part
    Real* out;
    Index out_row;
    const Real* start;    // null: zero; `out` itself: add to it
    Index start_row;      // 0: one row for all (a bias)
    Index first = 0;      // of the rows of b that take part
    bool padded = false;  // `start` and rows of `out` have room for padded_columns()
  };
  void multiply(const Product& product) const;
  /// Columns of whole panels, the last ones zero.
  Index padded_columns() const { return count() * kWidth; }

 private:
  Index count() const { return (columns_ + kWidth - 1) / kWidth; }
  Real* panel(Index k) const { return values_.data() + k * rows_ * kWidth; }

  Index rows_, columns_;
  Tensor values_;  // (panels, rows, kWidth): aligned to cache lines
};

}  // namespace dcnn
