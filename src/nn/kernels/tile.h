// SPDX-License-Identifier: Apache-2.0
// The one multiply-add loop behind convolution, its gradients, the fully connected layer's
// gradients and, in double, the sums of Levenberg and Marquardt.
#pragma once

#include <span>

#include "dcnn/core/tensor.h"

namespace dcnn {

/// A stretch of products whose factors lie at constant steps from these offsets.
struct Run {
  Index a, b, length;
};

/// out[r, c] = start[r, c] + sum over runs and k of
///             a[run.a + k·a_step + r·a_row] · b[run.b + k·b_step + c].
/// The order of every sum is that of the runs: it depends on neither `rows`, `columns` nor the
/// tiling.
template <class T>
struct TileProduct {
  const T* a;
  Index a_row, a_step;
  const T* b;
  Index b_step;
  std::span<const Run> runs;
  T* out;
  Index out_row;
  const T* start;   // null: zero; `out` itself: add to it
  Index start_row;  // 0: one row for all (a bias)
  Index rows, columns;
};

void tile_product(const TileProduct<float>& product);
void tile_product(const TileProduct<double>& product);

}  // namespace dcnn
