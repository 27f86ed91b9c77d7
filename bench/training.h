// One epoch of the DCNN as the paper trains it: what both benchmarks time.
#pragma once

#include <string>

#include "dcnn/nn/loss.h"
#include "dcnn/nn/network.h"
#include "dcnn/nn/optimizer.h"

namespace dcnn {

constexpr Index kSamples = 41729, kBatch = 50;  // spec 2.4: 834 iterations, the rest is skipped

/// Multiply-adds of the products of one prediction (spec 2.0).
inline double products(const std::string& padding) { return padding == "same" ? 508800 : 117024; }
/// And of one training sample: forward, weight gradient and, but for the first layer, input
/// gradient.
inline double training_products(const std::string& padding) {
  return 3 * products(padding) - (padding == "same" ? 15 * 5 : 14 * 4) * 4 * 8;
}

inline Json dcnn_layers(const std::string& padding) {
  Json layers = Json::array();
  for (const int count : {8, 16, 32, 32}) {
    layers.push_back({{"kind", "conv2d"}, {"filters", count}, {"padding", padding}});
    layers.push_back({{"kind", "batch_norm"}});
    layers.push_back({{"kind", "relu"}});
  }
  layers.push_back({{"kind", "dropout"}, {"rate", 0.5}});
  layers.push_back({{"kind", "flatten"}});
  layers.push_back({{"kind", "linear"}, {"outputs", 3}});
  return layers;
}

/// A network, its optimiser and random data of the paper's size.
class Training {
 public:
  explicit Training(const std::string& padding)
      : network(dcnn_layers(padding), {15, 5, 1}, rng_), adam_(network.state(), {}) {
    for (Real& value : x.values()) value = static_cast<Real>(rng_.normal());
    for (Real& value : wanted.values()) value = static_cast<Real>(rng_.normal());
  }

  void epoch() {
    for (Index first = 0; first + kBatch <= kSamples; first += kBatch) {
      Pass pass{.mode = Pass::Mode::kTrain, .rng = Rng({1, static_cast<std::uint64_t>(first)})};
      const Tensor batch = rows(x, first, {kBatch, 15, 5, 1});
      const Tensor loss =
          half_mean_squared_error(network.forward(batch, pass), rows(wanted, first, {kBatch, 3}));
      loss.backward();
      adam_.step(1e-3);
    }
  }

 private:
  static Tensor rows(const Tensor& from, Index first, const Shape& shape) {
    const Index width = element_count(shape) / shape[0];
    const auto begin = static_cast<std::size_t>(first * width);
    return Tensor::from(shape,
                        from.values().subspan(begin, static_cast<std::size_t>(kBatch * width)));
  }

  Rng rng_{1};

 public:
  Network network;
  Tensor x{{kSamples, 15, 5, 1}}, wanted{{kSamples, 3}};

 private:
  Adam adam_;
};

/// Measured multiply-adds per second of all threads together, in the widest vectors of this
/// machine.
double peak_multiply_adds();

}  // namespace dcnn
