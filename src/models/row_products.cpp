// SPDX-License-Identifier: Apache-2.0
#include "models/row_products.h"

#include "nn/kernels/tile.h"

namespace dcnn {
namespace {

/// to = (or +=) factor·values.
template <class Values>
void put(const Values& values, double factor, bool add, double* to) {
  Eigen::Map<Eigen::RowVectorXd> target(to, values.size());
  if (add) {
    target += factor * values;
  } else {
    target = factor * values;
  }
}

}  // namespace

void pair_products(const RowMatrix& x, Index first, Index count, bool add, RowMatrix& to) {
  for (Index row = 0; row < x.rows(); ++row) {
    const auto values = x.row(row).segment(first, count);
    double* products = to.row(row).data();
    for (Index i = 0; i < count; products += count - i, ++i) {
      put(values.tail(count - i), values[i], add, products);
    }
  }
}

void all_products(const RowMatrix& x, Index x_first, Index x_count, const RowMatrix& y,
                  Index y_first, Index y_count, bool add, RowMatrix& to) {
  for (Index row = 0; row < x.rows(); ++row) {
    const auto values = y.row(row).segment(y_first, y_count);
    double* products = to.row(row).data();
    for (Index i = 0; i < x_count; ++i, products += y_count) {
      put(values, x(row, x_first + i), add, products);
    }
  }
}

void add_product(const RowMatrix& a, const RowMatrix& b, double* sums) {
  const Run run{0, 0, a.rows()};
  tile_product(TileProduct<double>{.a = a.data(),
                                   .a_row = 1,
                                   .a_step = a.cols(),
                                   .b = b.data(),
                                   .b_step = b.cols(),
                                   .runs = {&run, 1},
                                   .out = sums,
                                   .out_row = b.cols(),
                                   .start = sums,
                                   .start_row = b.cols(),
                                   .rows = a.cols(),
                                   .columns = b.cols()});
}

}  // namespace dcnn
