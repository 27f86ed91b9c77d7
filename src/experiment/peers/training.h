// SPDX-License-Identifier: Apache-2.0
// One epoch of the networks as the paper trains them: what benchmarks time.
#pragma once

#include <cstdlib>
#include <string>

#include "dcnn/nn/loss.h"
#include "dcnn/nn/network.h"
#include "dcnn/nn/optimizer.h"
#include "nn/dcnn_layers.h"

namespace dcnn {

constexpr Index kSamples =
    41729;  // 834 iterations of the paper's batch of 50, the rest is skipped

/// A network at the size of the paper's data.
struct Task {
  std::string name;
  Json layers;
  Shape input;  // of one sample
  Index batch;
  double products;           // multiply-adds of one prediction
  double training_products;  // and of one training sample
  double clip = 0;

  Index batches() const { return kSamples / batch; }
};

inline Task dcnn_task(const std::string& padding) {
  const bool same = padding == "same";
  const double products = same ? 508800 : 117024;  // multiply-adds forwards
  // Forward, weight gradient and, but for the first layer, input gradient.
  const double training = 3 * products - (same ? 15 * 5 : 14 * 4) * 4 * 8;
  return {"dcnn-" + padding, dcnn_layers(padding), {15, 5, 1}, 50, products, training};
}

constexpr Index kLstmUnits = 150;

/// Spec 2.5 on windows of `steps` rows.
inline Task lstm_task(Index steps) {
  const Json layers = {{{"kind", "lstm"}, {"units", kLstmUnits}},
                       {{"kind", "dropout"}, {"rate", 0.5}},
                       {{"kind", "linear"}, {"outputs", 3}}};
  const double t = static_cast<double>(steps);
  const double input = t * 15 * 600, recurrent = (t - 1) * 150 * 600, output = 3 * 150;
  return {
      "lstm-" + std::to_string(steps),        layers, {steps, 15}, 200, input + recurrent + output,
      2 * input + 3 * recurrent + 3 * output, 1};
}

/// dcnn-valid, dcnn-same or lstm-T.
inline Task named_task(const std::string& name) {
  for (const char* padding : {"valid", "same"}) {
    if (Task task = dcnn_task(padding); task.name == name) return task;
  }
  const int steps = name.starts_with("lstm-") ? std::atoi(name.c_str() + 5) : 0;
  require(steps > 0, Exit::kUsage, "no training is called '", name, "'");
  return lstm_task(steps);
}

/// A network, its optimiser and random data of the task's size.
class Training {
 public:
  explicit Training(const Task& task)
      : network(task.layers, task.input, rng_),
        batch_(task.batch),
        adam_(network.state(), {.clip = task.clip}) {
    Shape shape = task.input;
    shape.insert(shape.begin(), kSamples);
    x = Tensor(shape);
    for (Real& value : x.values()) value = static_cast<Real>(rng_.normal());
    for (Real& value : wanted.values()) value = static_cast<Real>(rng_.normal());
  }

  void epoch() {
    const KeptMemory kept;
    for (Index first = 0; first + batch_ <= kSamples; first += batch_) {
      Pass pass{.mode = Pass::Mode::kTrain, .rng = Rng({1, static_cast<std::uint64_t>(first)})};
      const Tensor loss =
          half_mean_squared_error(network.forward(rows(x, first), pass), rows(wanted, first));
      loss.backward();
      adam_.step(1e-3);
    }
  }

 private:
  Tensor rows(const Tensor& from, Index first) const {
    Shape shape = from.shape();
    shape[0] = batch_;
    const Index width = from.size() / kSamples;
    return Tensor::from(shape, from.values().subspan(static_cast<std::size_t>(first * width),
                                                     static_cast<std::size_t>(batch_ * width)));
  }

  Rng rng_{1};

 public:
  Network network;
  Tensor x, wanted{{kSamples, 3}};

 private:
  Index batch_;
  Adam adam_;
};

}  // namespace dcnn
