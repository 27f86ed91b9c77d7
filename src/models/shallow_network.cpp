// SPDX-License-Identifier: Apache-2.0
#include "models/shallow_network.h"

#include <cmath>

#include "nn/kernels/tile.h"

namespace dcnn {
namespace {

/// Rows of signals and where their sums go; `signals_row`, `to_row` values lie between them.
struct Rows {
  const double* signals;
  Index signals_row;
  double* to;
  Index to_row, count;
};

/// to (n, units) = biases + signals·weights.
void layer_sums(const ShallowNetwork::Layer& layer, const Eigen::VectorXd& weights,
                const Rows& rows) {
  const double* of_layer = weights.data() + layer.offset;
  const Run run{0, 0, layer.width};
  tile_product(TileProduct<double>{.a = rows.signals + layer.first,
                                   .a_row = rows.signals_row,
                                   .a_step = 1,
                                   .b = of_layer + layer.units,
                                   .b_step = layer.units,
                                   .runs = {&run, 1},
                                   .out = rows.to,
                                   .out_row = rows.to_row,
                                   .start = of_layer,
                                   .start_row = 0,
                                   .rows = rows.count,
                                   .columns = layer.units});
}

/// Fills in the hidden units of (n, signals) and the outputs.
void run_layers(const ShallowNetwork& network, const Eigen::VectorXd& weights, double* signals,
                Index count, double* outputs) {
  const Index width = network.signals();
  for (const ShallowNetwork::Layer& layer : network.layers()) {
    if (&layer == &network.layers().back()) {
      layer_sums(layer, weights, {signals, width, outputs, network.shape().outputs, count});
      return;
    }
    layer_sums(layer, weights, {signals, width, signals + layer.place, width, count});
    for (Index row = 0; row < count; ++row) {
      double* unit = signals + row * width + layer.place;
      for (Index i = 0; i < layer.units; ++i) unit[i] = std::tanh(unit[i]);
    }
  }
}

/// Directions drawn at random, lengths and biases such that the active ranges of the units, whose
/// inputs lie in [-1, 1] and whose tanh is active in [-2, 2], cover the input space evenly.
void nguyen_widrow(const ShallowNetwork::Layer& layer, Rng& rng, Eigen::VectorXd& weights) {
  Eigen::Map<RowMatrix> w(weights.data() + layer.offset, 1 + layer.width, layer.units);
  const auto units = static_cast<double>(layer.units);
  const double gain = 2.0 * 0.7 * std::pow(units, 1.0 / static_cast<double>(layer.width));
  for (Index i = 0; i < layer.units; ++i) {
    auto direction = w.col(i).tail(layer.width);
    for (double& value : direction) value = rng.uniform(-1.0, 1.0);
    direction *= gain / direction.norm();
    const double spot = layer.units == 1 ? 0.0 : 2.0 * static_cast<double>(i) / (units - 1.0) - 1.0;
    w(0, i) = gain * spot * std::copysign(1.0, direction[0]);
  }
}

}  // namespace

ShallowNetwork::ShallowNetwork(const Shape& shape) : shape_(shape) {
  Index place = shape.inputs, offset = 0, before = 0;
  std::vector<Index> sizes = shape.hidden;
  sizes.push_back(shape.outputs);
  for (const Index units : sizes) {
    const Index first = shape.cascade ? 0 : before;
    layers_.push_back({units, first, place - first, offset, place});
    offset += layers_.back().size();
    before = place;
    place += units;
  }
}

Eigen::VectorXd ShallowNetwork::initial_weights(Rng& rng) const {
  Eigen::VectorXd weights(parameter_count());
  for (const Layer& layer : layers_) {
    if (&layer != &layers_.back()) {
      nguyen_widrow(layer, rng, weights);
    } else {
      for (double& value : weights.tail(layer.size())) value = rng.uniform(-1.0, 1.0);
    }
  }
  return weights;
}

RowMatrix ShallowNetwork::forward(const Eigen::VectorXd& weights, RowMatrix& signals) const {
  RowMatrix outputs(signals.rows(), shape_.outputs);
  run_layers(*this, weights, signals.data(), signals.rows(), outputs.data());
  return outputs;
}

void ShallowNetwork::forward(const Eigen::VectorXd& weights, Eigen::RowVectorXd& signals,
                             Eigen::RowVectorXd& outputs) const {
  run_layers(*this, weights, signals.data(), 1, outputs.data());
}

}  // namespace dcnn
