// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/network.h"

#include <algorithm>
#include <cmath>

#include "nn/batch_norm.h"
#include "nn/init.h"

namespace dcnn {
namespace {

constexpr std::size_t kMostLayers = 256;

const LayerKind& find_kind(const std::string& name, const std::string& where) {
  std::vector<std::string> names;
  for (const LayerKind* kind : layer_kinds()) {
    if (kind->name == name) return *kind;
    names.emplace_back(kind->name);
  }
  const auto near = nearest_word(name, names);
  fail(Exit::kUsage, where, ": unknown kind '", name, "'",
       near.empty() ? "" : "; did you mean '" + near + "'?");
}

Shape with_batch(const Shape& sample) {
  Shape shape{1};
  shape.insert(shape.end(), sample.begin(), sample.end());
  return shape;
}

std::string kind_of(const Json& layer) { return layer.at("kind").get<std::string>(); }

/// weight and bias, per output o: w·scale[o], (b - mean[o])·scale[o] + beta[o].
void fold(const Tensor& weight, const Tensor& bias, bool output_first,
          const std::vector<NamedTensor>& norm) {
  const Tensor &gamma = norm[0].tensor, &beta = norm[1].tensor;
  const Tensor &mean = norm[2].tensor, &variance = norm[3].tensor;
  const Index outputs = bias.size(), per_output = weight.size() / outputs;
  for (Index o = 0; o < outputs; ++o) {
    const double deviation = std::sqrt(static_cast<double>(variance.data()[o]) + kBatchNormEpsilon);
    const Real scale = static_cast<Real>(static_cast<double>(gamma.data()[o]) / deviation);
    for (Index i = 0; i < per_output; ++i) {
      weight.data()[output_first ? o * per_output + i : i * outputs + o] *= scale;
    }
    bias.data()[o] = (bias.data()[o] - mean.data()[o]) * scale + beta.data()[o];
  }
}

}  // namespace

Network::Network(const Json& layers, const Shape& input, Rng& rng)
    : layers_(layers), input_(input), shapes_{input} {
  require(layers.is_array() && !layers.empty(), Exit::kUsage,
          "layers: must be a list of at least one layer");
  const NoGradient guard;
  Tensor x(with_batch(input));
  Layer* before = nullptr;  // the last one that does its work itself
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::string place = "layer " + std::to_string(i);
    Options options(layers[i], place, Exit::kUsage);
    const auto& kind = find_kind(options.get<std::string>("kind"), place);
    stack_.push_back(kind.make(options, shapes_.back(), rng));
    options.finish();
    absorbed_.push_back(before && stack_.back()->join(*before));
    if (!absorbed_.back()) before = stack_.back().get();
    require(i < kMostLayers && parameter_count() <= kMostWeights, Exit::kUsage, place,
            ": more than ", kMostLayers, " layers or ", kMostWeights,
            " weights; use a smaller network");
    for (auto& named : stack_.back()->state()) {
      named.name = std::to_string(i) + "." + kind.name + "." + named.name;
      state_.push_back(std::move(named));
    }
    Pass pass;
    x = stack_.back()->forward(x, pass);
    shapes_.emplace_back(x.shape().begin() + 1, x.shape().end());
  }
}

Tensor Network::forward(const Tensor& x, Pass& pass) const {
  Tensor y = x;
  for (std::size_t i = 0; i < stack_.size(); ++i) {
    if (!absorbed_[i]) y = stack_[i]->forward(y, pass);
  }
  return y;
}

bool Network::is_divisible() const {
  return std::ranges::all_of(stack_, [](const LayerPtr& layer) { return layer->is_divisible(); });
}

Index Network::parameter_count() const {
  Index count = 0;
  for (const auto& named : state_) {
    if (named.role != NamedTensor::Role::kStatistic) count += named.tensor.size();
  }
  return count;
}

Network Network::folded() const {
  Json kept = Json::array();
  std::vector<std::size_t> origin;   // of each layer kept
  std::vector<std::size_t> norm_of;  // the batch norm folded into it, or 0
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const bool norm = kind_of(layers_[i]) == "batch_norm";
    const auto before = i > 0 ? kind_of(layers_[i - 1]) : "";
    if (norm && (before == "conv2d" || before == "linear")) {
      norm_of.back() = i;
      continue;
    }
    kept.push_back(layers_[i]);
    origin.push_back(i);
    norm_of.push_back(0);
  }
  Rng rng(0);  // every value is overwritten
  Network network(kept, input_, rng);
  for (std::size_t k = 0; k < origin.size(); ++k) {
    const auto from = stack_[origin[k]]->state(), to = network.stack_[k]->state();
    for (std::size_t t = 0; t < to.size(); ++t) {
      std::ranges::copy(from[t].tensor.values(), to[t].tensor.data());
    }
    if (norm_of[k] == 0) continue;
    const bool output_first = kind_of(kept[k]) == "linear";
    fold(to[0].tensor, to[1].tensor, output_first, stack_[norm_of[k]]->state());
  }
  return network;
}

Plan Network::plan(Precision precision) const {
  const Network network = folded();
  const NoGradient guard;
  Pass pass;
  Plan plan(element_count(input_));
  PlanStep* before = nullptr;
  Tensor x(with_batch(input_));
  for (const auto& layer : network.stack_) {
    auto step = layer->plan(Shape(x.shape().begin() + 1, x.shape().end()), before);
    if (step) before = step.get();
    x = layer->forward(x, pass);
    plan.add(std::move(step), x.size());
  }
  require(precision == Precision::kSingle || plan.use_int16(), Exit::kUsage,
          "no layer of this network multiplies in 16-bit integers: those of dcnn at the paper's "
          "sizes do; leave the precision at single");
  return plan;
}

}  // namespace dcnn
