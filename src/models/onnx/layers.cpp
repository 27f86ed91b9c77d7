// SPDX-License-Identifier: Apache-2.0
#include "models/onnx/layers.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "nn/batch_norm.h"

namespace dcnn::onnx {
namespace {

/// The value being passed on, and what its axes are.
struct Flow {
  std::string value;
  Shape sample;  ///< as our network has it: (H, W, C), (T, F) or (F)
  /// (H, W, C) of a flattened image whose values lie channels-first still; empty where they lie as
  /// ours do.
  Shape unordered;
  bool carries = false;  ///< the state of an LSTM goes on from call to call
};

using Weights = std::map<std::string, Tensor>;

std::vector<float> list_of(const Tensor& t) { return {t.values().begin(), t.values().end()}; }

/// (window_h, window_w, C, filters) as (filters, C, window_h, window_w).
std::vector<float> filters_first(const Tensor& weight) {
  const Index taps = weight.dim(0) * weight.dim(1), channels = weight.dim(2);
  const Index filters = weight.dim(3);
  std::vector<float> values(static_cast<std::size_t>(weight.size()));
  auto* to = values.data();
  for (Index f = 0; f < filters; ++f) {
    for (Index c = 0; c < channels; ++c) {
      for (Index tap = 0; tap < taps; ++tap) {
        *to++ = static_cast<float>(weight.data()[(tap * channels + c) * filters + f]);
      }
    }
  }
  return values;
}

/// (outputs, H·W·C) as (outputs, C·H·W).
std::vector<float> channels_first(const Tensor& weight, const Shape& image) {
  const Index places = image[0] * image[1], channels = image[2];
  std::vector<float> values(static_cast<std::size_t>(weight.size()));
  auto* to = values.data();
  for (Index o = 0; o < weight.dim(0); ++o) {
    const Real* from = weight.data() + o * weight.dim(1);
    for (Index c = 0; c < channels; ++c) {
      for (Index p = 0; p < places; ++p) *to++ = static_cast<float>(from[p * channels + c]);
    }
  }
  return values;
}

void add_conv2d(const Json& layer, const Weights& weights, Graph& graph, Flow& flow) {
  const Tensor &weight = weights.at("weight"), &bias = weights.at("bias");
  const Index h = weight.dim(0), w = weight.dim(1);
  std::vector<Index> zeros{0, 0, 0, 0};  // above, left, below, right
  if (layer.value("padding", "same") == "same") {
    zeros = {(h - 1) / 2, (w - 1) / 2, h - 1 - (h - 1) / 2, w - 1 - (w - 1) / 2};
  }
  const auto kernel =
      graph.constant("weight", {weight.dim(3), weight.dim(2), h, w}, filters_first(weight));
  const auto offset = graph.constant("bias", bias.shape(), list_of(bias));
  flow.value = graph.node("Conv", {flow.value, kernel, offset},
                          {wholes("kernel_shape", {h, w}), wholes("pads", zeros)});
}

void add_batch_norm(const Weights& weights, Graph& graph, Flow& flow) {
  const Tensor &gamma = weights.at("gamma"), &beta = weights.at("beta");
  std::vector<float> scale, offset;
  for (Index c = 0; c < gamma.size(); ++c) {
    const double deviation =
        std::sqrt(static_cast<double>(weights.at("running_var").data()[c]) + kBatchNormEpsilon);
    const double factor = static_cast<double>(gamma.data()[c]) / deviation;
    const double mean = static_cast<double>(weights.at("running_mean").data()[c]);
    scale.push_back(static_cast<float>(factor));
    offset.push_back(static_cast<float>(static_cast<double>(beta.data()[c]) - mean * factor));
  }
  Shape shape{gamma.size()};
  if (flow.sample.size() == 3) shape = {gamma.size(), 1, 1};
  const auto product = graph.node("Mul", {flow.value, graph.constant("scale", shape, scale)});
  flow.value = graph.node("Add", {product, graph.constant("offset", shape, offset)});
}

void add_linear(const Weights& weights, Graph& graph, Flow& flow) {
  const Tensor &weight = weights.at("weight"), &bias = weights.at("bias");
  const auto matrix = graph.constant(
      "weight", weight.shape(),
      flow.unordered.empty() ? list_of(weight) : channels_first(weight, flow.unordered));
  flow.unordered.clear();
  flow.value =
      graph.node("Gemm", {flow.value, matrix, graph.constant("bias", bias.shape(), list_of(bias))},
                 {whole("transB", 1)});
}

/// (rows, 4H) with the columns i | f | g | o as (1, 4H, rows) with the blocks i, o, f, g.
std::vector<float> gate_rows(const Tensor& weight, Index rows) {
  const Index units = weight.size() / rows / 4;
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(weight.size()));
  for (const Index gate : {0, 3, 1, 2}) {
    for (Index u = 0; u < units; ++u) {
      for (Index r = 0; r < rows; ++r) {
        values.push_back(static_cast<float>(weight.data()[(r * 4 + gate) * units + u]));
      }
    }
  }
  return values;
}

void add_lstm(const Json& layer, const Weights& weights, Graph& graph, Flow& flow) {
  const Tensor &input = weights.at("input_weight"), &recurrent = weights.at("recurrent_weight");
  const Index units = recurrent.dim(0), gates = 4 * units;
  std::vector<float> bias = gate_rows(weights.at("bias"), 1);
  bias.resize(static_cast<std::size_t>(2 * gates));  // ONNX adds a second one to the recurrent part
  const auto steps_first = graph.node("Transpose", {flow.value}, {wholes("perm", {1, 0, 2})});
  std::vector<std::string> inputs{
      steps_first,
      graph.constant("weight", {1, gates, input.dim(0)}, gate_rows(input, input.dim(0))),
      graph.constant("recurrent", {1, gates, units}, gate_rows(recurrent, units)),
      graph.constant("bias", {1, 2 * gates}, bias)};
  const std::vector<Message> size{whole("hidden_size", units)};
  if (flow.carries) {
    inputs.insert(inputs.end(), {"", "h", "c"});
    const auto next = graph.node_outputs("LSTM", 1, 2, inputs, size);  // (1, N, H) both
    graph.carry("h", units, next[0]);
    graph.carry("c", units, next[1]);
    flow.value = graph.node("Squeeze", {next[0], graph.constant("axis", {0})});
  } else if (layer.value("sequence", false)) {
    const auto all = graph.node("LSTM", inputs, size);  // (T, 1, N, H)
    const auto squeezed = graph.node("Squeeze", {all, graph.constant("axis", {1})});
    flow.value = graph.node("Transpose", {squeezed}, {wholes("perm", {1, 0, 2})});
  } else {
    const auto newest = graph.node_outputs("LSTM", 1, 1, inputs, size)[0];  // (1, N, H)
    flow.value = graph.node("Squeeze", {newest, graph.constant("axis", {0})});
  }
}

void add_flatten(Graph& graph, Flow& flow) {
  if (flow.sample.size() == 3) flow.unordered = flow.sample;
  flow.value = graph.node("Flatten", {flow.value}, {whole("axis", 1)});
}

/// Puts a flattened image whose values nobody has reordered yet in our order.
void restore_order(Graph& graph, Flow& flow) {
  if (flow.unordered.empty()) return;
  const Shape& image = flow.unordered;
  const auto parts = graph.node(
      "Reshape", {flow.value, graph.constant("shape", {-1, image[2], image[0], image[1]})});
  const auto turned = graph.node("Transpose", {parts}, {wholes("perm", {0, 2, 3, 1})});
  flow.value = graph.node("Flatten", {turned}, {whole("axis", 1)});
  flow.unordered.clear();
}

void add_layer(const Json& layer, const Weights& weights, Graph& graph, Flow& flow) {
  const auto kind = layer.at("kind").get<std::string>();
  if (kind == "conv2d") return add_conv2d(layer, weights, graph, flow);
  if (kind == "linear") return add_linear(weights, graph, flow);
  if (kind == "lstm") return add_lstm(layer, weights, graph, flow);
  if (kind == "flatten") return add_flatten(graph, flow);
  if (kind == "relu") return void(flow.value = graph.node("Relu", {flow.value}));
  if (kind == "tanh") return void(flow.value = graph.node("Tanh", {flow.value}));
  if (kind == "dropout") return;
  require(kind == "batch_norm", Exit::kUsage, "a layer '", kind, "' cannot be written as ONNX");
  restore_order(graph, flow);
  add_batch_norm(weights, graph, flow);
}

}  // namespace

Shape sample_shape(const Network& network) {
  Shape shape = network.input();
  if (shape.size() == 3) std::rotate(shape.begin(), shape.end() - 1, shape.end());
  return shape;
}

std::string add_layers(const Network& whole_network, Graph& graph, const std::string& input,
                       bool carries) {
  const Network network = whole_network.folded();
  Flow flow{input, network.input(), {}, carries};
  for (Index i = 0; i < static_cast<Index>(network.layers().size()); ++i) {
    const std::string prefix = std::to_string(i) + ".";
    Weights weights;
    for (const NamedTensor& named : network.state()) {
      if (!named.name.starts_with(prefix)) continue;
      weights[named.name.substr(named.name.rfind('.') + 1)] = named.tensor;
    }
    add_layer(network.layers()[i], weights, graph, flow);
    flow.sample = network.shapes()[static_cast<std::size_t>(i) + 1];
  }
  restore_order(graph, flow);
  return flow.value;
}

}  // namespace dcnn::onnx
