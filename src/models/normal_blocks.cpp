// SPDX-License-Identifier: Apache-2.0
#include "models/normal_blocks.h"

#include <utility>

namespace dcnn {
namespace {

Index pairs(Index n) { return n * (n + 1) / 2; }

}  // namespace

struct NormalBlocks::Rows {
  std::vector<RowMatrix> signals;  // of each layer, (n, 1 + width), ones in front
  std::vector<RowMatrix> slopes;   // of each hidden layer, (n, units): derivative of tanh
  std::vector<RowMatrix> deltas;   // of each hidden layer, (n, outputs·units)
};

NormalBlocks::NormalBlocks(const ShallowNetwork& network, Eigen::VectorXd scale)
    : network_(network), scale_(std::move(scale)), size_(network.parameter_count()) {
  for (std::size_t first = 0; first < network.layers().size(); ++first) {
    for (std::size_t second = first; second < network.layers().size(); ++second) {
      blocks_.push_back(make_block(first, second));
      size_ += blocks_.back().deltas * blocks_.back().signals;
    }
  }
}

NormalBlocks::Block NormalBlocks::make_block(std::size_t first, std::size_t second) const {
  const auto &l = network_.layers()[first], &m = network_.layers()[second];
  const Index signals = first == second ? pairs(1 + l.width) : (1 + l.width) * (1 + m.width);
  Index deltas = l.units * m.units;
  if (first == second) deltas = is_output(first) ? 1 : pairs(l.units);
  if (first != second && is_output(second) && is_last_hidden(first)) deltas = l.units;
  return {first, second, deltas, signals, size_};
}

NormalBlocks::Rows NormalBlocks::prepare(const Eigen::VectorXd& weights,
                                         const RowMatrix& signals) const {
  const auto& layers = network_.layers();
  const auto hidden = static_cast<std::size_t>(network_.hidden_layers());
  Rows rows;
  rows.slopes.resize(hidden);
  rows.deltas.resize(hidden);
  for (const auto& layer : layers) {
    rows.signals.emplace_back(signals.rows(), 1 + layer.width);
    rows.signals.back().col(0).setOnes();
    rows.signals.back().rightCols(layer.width) = signals.middleCols(layer.first, layer.width);
  }
  for (std::size_t l = hidden; l-- > 0;) {
    rows.slopes[l] = 1.0 - signals.middleCols(layers[l].place, layers[l].units).array().square();
    rows.deltas[l] = deltas(l, weights, rows);
  }
  return rows;
}

/// Back from every layer that sees layer l; the output layer's own delta is its scale.
RowMatrix NormalBlocks::deltas(std::size_t l, const Eigen::VectorXd& weights,
                               const Rows& rows) const {
  const auto& layers = network_.layers();
  const Index units = layers[l].units, outputs = scale_.size();
  RowMatrix result = RowMatrix::Zero(rows.slopes[l].rows(), outputs * units);
  for (std::size_t m = l + 1; m < layers.size(); ++m) {
    const Index seen = layers[l].place - layers[m].first;
    if (seen < 0 || seen >= layers[m].width) continue;
    const auto between = ShallowNetwork::weights_of(layers[m], weights).middleRows(1 + seen, units);
    for (Index k = 0; k < outputs; ++k) {
      auto delta = result.middleCols(k * units, units);
      if (is_output(m)) {
        delta.rowwise() += scale_[k] * between.col(k).transpose();
      } else {
        const auto later = rows.deltas[m].middleCols(k * layers[m].units, layers[m].units);
        delta += later * between.transpose();
      }
    }
  }
  for (Index k = 0; k < outputs; ++k) {
    result.middleCols(k * units, units).array() *= rows.slopes[l].array();
  }
  return result;
}

RowMatrix NormalBlocks::delta_products(const Block& block, const Rows& rows) const {
  const std::size_t l = block.first, m = block.second;
  const Index n = rows.signals[0].rows(), outputs = scale_.size();
  if (is_output(l)) return RowMatrix::Ones(n, 1);
  const Index units = network_.layers()[l].units;
  if (is_output(m)) {
    if (is_last_hidden(l)) return rows.slopes[l];
    RowMatrix products = rows.deltas[l];
    for (Index k = 0; k < outputs; ++k) products.middleCols(k * units, units) *= scale_[k];
    return products;
  }
  RowMatrix products(n, block.deltas);
  if (l == m && is_last_hidden(l)) {
    pair_products(rows.slopes[l], 0, units, false, products);
    return products;
  }
  const Index others = network_.layers()[m].units;
  for (Index k = 0; k < outputs; ++k) {
    if (l == m) {
      pair_products(rows.deltas[l], k * units, units, k > 0, products);
    } else {
      all_products(rows.deltas[l], k * units, units, rows.deltas[m], k * others, others, k > 0,
                   products);
    }
  }
  return products;
}

RowMatrix NormalBlocks::signal_products(const Block& block, const Rows& rows) const {
  const RowMatrix &a = rows.signals[block.first], &b = rows.signals[block.second];
  RowMatrix products(a.rows(), block.signals);
  if (block.first == block.second) {
    pair_products(a, 0, a.cols(), false, products);
  } else {
    all_products(a, 0, a.cols(), b, 0, b.cols(), false, products);
  }
  return products;
}

void NormalBlocks::add_gradient(const Rows& rows, const RowMatrix& errors, double* sums) const {
  for (std::size_t l = 0; l < network_.layers().size(); ++l) {
    const auto& layer = network_.layers()[l];
    RowMatrix delta = RowMatrix::Zero(errors.rows(), layer.units);
    for (Index k = 0; k < scale_.size(); ++k) {
      if (is_output(l)) {
        delta.col(k) = scale_[k] * errors.col(k);
      } else {
        delta.array() += rows.deltas[l].middleCols(k * layer.units, layer.units).array().colwise() *
                         errors.col(k).array();
      }
    }
    add_product(rows.signals[l], delta, sums + layer.offset);
  }
}

void NormalBlocks::add(const Eigen::VectorXd& weights, const RowMatrix& signals,
                       const RowMatrix& errors, double* sums) const {
  const Rows rows = prepare(weights, signals);
  add_gradient(rows, errors, sums);
  for (const Block& block : blocks_) {
    add_product(delta_products(block, rows), signal_products(block, rows), sums + block.offset);
  }
}

/// (units, outputs): what a unit of the last hidden layer is worth in the error of each output.
Eigen::MatrixXd NormalBlocks::worth(const Eigen::VectorXd& weights) const {
  const auto &output = network_.layers().back(), &last = network_.layers().end()[-2];
  return ShallowNetwork::weights_of(output, weights)
             .middleRows(1 + last.place - output.first, last.units) *
         scale_.asDiagonal();
}

std::vector<NormalBlocks::Term> NormalBlocks::terms(const Block& block,
                                                    const Eigen::VectorXd& weights) const {
  const Index l = network_.layers()[block.first].units, m = network_.layers()[block.second].units;
  const bool last = is_last_hidden(block.first), same = block.first == block.second;
  const Eigen::MatrixXd drawn_out = worth(weights), squared = drawn_out * drawn_out.transpose();
  std::vector<Term> list;
  Index product = 0;
  if (is_output(block.first)) {
    for (Index k = 0; k < m; ++k) list.push_back({k, k, 0, scale_[k] * scale_[k]});
  } else if (is_output(block.second)) {
    for (Index k = 0; k < m; ++k) {
      for (Index i = 0; i < l; ++i) {
        list.push_back(last ? Term{i, k, i, scale_[k] * drawn_out(i, k)}
                            : Term{i, k, product++, 1.0});
      }
    }
  } else {
    for (Index i = 0; i < l; ++i) {
      for (Index j = same ? i : 0; j < m; ++j) {
        list.push_back({i, j, product++, same && last ? squared(i, j) : 1.0});
      }
    }
  }
  return list;
}

void NormalBlocks::unpack(const Eigen::VectorXd& weights, const double* sums, Eigen::MatrixXd& jtj,
                          Eigen::VectorXd& jte) const {
  const Index size = network_.parameter_count();
  jte = Eigen::Map<const Eigen::VectorXd>(sums, size);
  jtj.setZero(size, size);
  for (const Block& block : blocks_) {
    const auto &l = network_.layers()[block.first], &m = network_.layers()[block.second];
    const bool same = block.first == block.second;
    for (const Term& term : terms(block, weights)) {
      const double* value = sums + block.offset + term.product * block.signals;
      for (Index a = 0; a <= l.width; ++a) {
        for (Index b = same ? a : 0; b <= m.width; ++b) {
          const double entry = term.factor * *value++;
          const auto set = [&](Index first, Index second) {
            const Index row = l.offset + first * l.units + term.i;
            const Index column = m.offset + second * m.units + term.j;
            jtj(row, column) = jtj(column, row) = entry;
          };
          set(a, b);
          if (same) set(b, a);
        }
      }
    }
  }
}

}  // namespace dcnn
