// SPDX-License-Identifier: Apache-2.0
// J^T J and J^T e of a shallow network without its Jacobian.
#pragma once

#include <vector>

#include "models/shallow_network.h"

namespace dcnn {

/// Sums over rows of J^T J and J^T e, where J = d(scale_k·output_k)/dw.
///
/// A row of J is, for a weight from signal a to unit i of layer l, delta^l_ki·s^l_a, so the part of
/// J^T J between layers l and m is sum over rows of (sum over k of delta^l_ki·delta^m_kj)·(s^l_a·
/// s^m_b): a product of two matrices with a row per sample, products of deltas and products of
/// signals, of which equal ones (i and j, or a and b, exchanged) are formed once. Where a delta is
/// a weight times what does not depend on k, the weight is drawn out of the sum. For one hidden
/// layer of 20 units, 15 inputs and 3 outputs that is a sixth of the multiplications of J^T J.
class NormalBlocks {
 public:
  NormalBlocks(const ShallowNetwork& network, Eigen::VectorXd scale);

  /// Doubles in one array of sums.
  Index size() const { return size_; }

  /// Adds rows to the sums, given all their signals and their errors (n, outputs).
  void add(const Eigen::VectorXd& weights, const RowMatrix& signals, const RowMatrix& errors,
           double* sums) const;

  /// From sums over all rows to the symmetric J^T J and to J^T e.
  void unpack(const Eigen::VectorXd& weights, const double* sums, Eigen::MatrixXd& jtj,
              Eigen::VectorXd& jte) const;

 private:
  struct Block {
    std::size_t first, second;  // layers, first <= second
    Index deltas, signals;      // products: columns of the two factors
    Index offset;               // among the sums
  };
  struct Term {  // units i of the first layer and j of the second have factor·(this product of
                 // deltas)
    Index i, j, product;
    double factor;
  };
  struct Rows;  // what the blocks share for a set of rows

  bool is_output(std::size_t layer) const { return layer + 1 == network_.layers().size(); }
  bool is_last_hidden(std::size_t layer) const { return layer + 2 == network_.layers().size(); }
  Block make_block(std::size_t first, std::size_t second) const;
  Rows prepare(const Eigen::VectorXd& weights, const RowMatrix& signals) const;
  RowMatrix deltas(std::size_t layer, const Eigen::VectorXd& weights, const Rows& rows) const;
  RowMatrix delta_products(const Block& block, const Rows& rows) const;
  RowMatrix signal_products(const Block& block, const Rows& rows) const;
  void add_gradient(const Rows& rows, const RowMatrix& errors, double* sums) const;
  Eigen::MatrixXd worth(const Eigen::VectorXd& weights) const;
  std::vector<Term> terms(const Block& block, const Eigen::VectorXd& weights) const;

  const ShallowNetwork& network_;
  Eigen::VectorXd scale_;
  std::vector<Block> blocks_;
  Index size_;
};

}  // namespace dcnn
