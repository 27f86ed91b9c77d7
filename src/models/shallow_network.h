// SPDX-License-Identifier: Apache-2.0
// Feed-forward and cascade-forward networks with hidden tanh layers and linear outputs.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/core/random.h"
#include "models/row_products.h"

namespace dcnn {

/// The function alone; its weights are one vector that the caller holds. All signals of one sample
/// lie in one row: the inputs, then the units of each hidden layer.
class ShallowNetwork {
 public:
  struct Shape {
    Index inputs = 0;
    std::vector<Index> hidden;
    Index outputs = 0;
    bool cascade = false;  ///< every layer also sees the inputs and all earlier layers
  };

  /// One layer: each unit sums a bias and the signals [first, first + width). Its weights begin at
  /// `offset` as a row-major (1 + width, units) matrix, the biases in its first row.
  struct Layer {
    Index units = 0, first = 0, width = 0, offset = 0;
    Index place = 0;  ///< of its first unit among the signals; hidden layers only

    Index size() const { return (1 + width) * units; }
  };

  explicit ShallowNetwork(const Shape& shape);

  const Shape& shape() const { return shape_; }
  const std::vector<Layer>& layers() const { return layers_; }  ///< the output layer last
  Index hidden_layers() const { return static_cast<Index>(layers_.size()) - 1; }
  Index signals() const { return layers_.back().place; }
  Index parameter_count() const { return layers_.back().offset + layers_.back().size(); }

  /// The (1 + width, units) weights of a layer.
  static Eigen::Map<const RowMatrix> weights_of(const Layer& layer,
                                                const Eigen::VectorXd& weights) {
    return {weights.data() + layer.offset, 1 + layer.width, layer.units};
  }

  /// Hidden layers by Nguyen and Widrow (1990), the output layer uniform in [-1, 1].
  Eigen::VectorXd initial_weights(Rng& rng) const;

  /// (n, outputs) from signals (n, signals()) whose inputs are set; fills in the hidden units. A
  /// row's result does not depend on the others.
  RowMatrix forward(const Eigen::VectorXd& weights, RowMatrix& signals) const;

  /// The same for one sample: outputs from signals whose inputs are set. Allocates nothing.
  void forward(const Eigen::VectorXd& weights, Eigen::RowVectorXd& signals,
               Eigen::RowVectorXd& outputs) const;

 private:
  Shape shape_;
  std::vector<Layer> layers_;
};

}  // namespace dcnn
