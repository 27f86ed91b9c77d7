// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/onnx.h"

#include <limits>

#include "models/onnx/layers.h"
#include "models/tensor_io.h"

namespace dcnn {
namespace {

using onnx::Graph;

std::vector<float> floats(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

std::vector<float> numbers(const Json& json, const std::string& key) {
  return floats(json.at(key).get<std::vector<double>>());
}

/// A model's file, from which the steps around its network are read.
class Around {
 public:
  explicit Around(const Identifier& identifier)
      : name_(identifier.name), file_(pack(identifier)), map_(text("map")) {}

  /// "features" as the network's input; `sample` becomes the shape of one row of them.
  std::string before(Graph& graph, Shape& sample) const {
    sample = {static_cast<Index>(map_["mean"].size())};
    if (file_.find("input_least")) return scaled(graph);
    const Json input = text("input");
    const auto kind = input.at("kind").get<std::string>();
    if (kind == "map") return mapped(graph);
    require(kind == "window", Exit::kUsage, "a ", name_, " that reads '", kind,
            "' cannot be written as ONNX; give one that reads the features themselves");
    sample.insert(sample.begin(), input.at("length").get<Index>());
    return standardised(graph);
  }

  /// The network's output in the targets' units.
  std::string after(Graph& graph, const std::string& y) const {
    std::vector<float> offset, factor;
    if (file_.metadata.contains("target_scale")) {
      offset = numbers(text("target_scale"), "mean");
      factor = numbers(text("target_scale"), "deviation");
    } else {
      offset = floats(list_of(stored_row(file_, "target_middle", name_)));
      factor = floats(list_of(stored_row(file_, "target_half_range", name_)));
    }
    return sum(graph, product(graph, y, factor), offset);
  }

 private:
  Json text(const std::string& key) const { return Json::parse(stored_text(file_, key, name_)); }

  static std::string row(Graph& graph, const std::vector<float>& values) {
    return graph.constant("c", {static_cast<Index>(values.size())}, values);
  }
  static std::string sum(Graph& graph, const std::string& x, const std::vector<float>& values) {
    return graph.node("Add", {x, row(graph, values)});
  }
  static std::string difference(Graph& graph, const std::string& x,
                                const std::vector<float>& values) {
    return graph.node("Sub", {x, row(graph, values)});
  }
  static std::string product(Graph& graph, const std::string& x, const std::vector<float>& values) {
    return graph.node("Mul", {x, row(graph, values)});
  }

  /// Columns mapped to [-1, 1] by their range in training.
  std::string scaled(Graph& graph) const {
    require(text("input").is_null(), Exit::kUsage, "a ", name_,
            " with model.input cannot be written as ONNX; give one that reads the features");
    const auto columns = stored_values<Index>(file_, "input_columns", name_);
    const auto least = stored_row(file_, "input_least", name_);
    const auto most = stored_row(file_, "input_most", name_);
    const Eigen::RowVectorXd factor = 2.0 / (most - least).array();
    const auto chosen = graph.node("Gather", {"features", graph.constant("columns", columns)},
                                   {onnx::whole("axis", 1)});
    const auto centred = difference(graph, chosen, floats(list_of(least)));
    return sum(graph, product(graph, centred, floats(list_of(factor))), {-1.0F});
  }

  /// Eq. 7: (N, 1, F, 5).
  std::string mapped(Graph& graph) const {
    const Index rows = static_cast<Index>(map_["mean"].size());
    const std::string x = clipped(graph);
    const auto centred = difference(graph, x, numbers(map_, "mean"));
    const std::vector<std::string> columns{x, centred, product(graph, centred, inverse_scale()),
                                           graph.node("Abs", {x}), graph.node("Mul", {x, x})};
    const auto shape = graph.constant("shape", std::vector<Index>{-1, 1, rows, 1});
    std::vector<std::string> stacked;
    for (const auto& column : columns) stacked.push_back(graph.node("Reshape", {column, shape}));
    const auto map = graph.node("Concat", stacked, {onnx::whole("axis", 3)});
    const auto centre =
        graph.constant("centre", {rows, InputMap::kColumns}, numbers(map_, "centre"));
    return graph.node("Sub", {map, centre});
  }

  std::string clipped(Graph& graph) const {
    const auto width = map_["clip"].get<double>();
    if (width <= 0.0) return "features";
    const auto mean = map_["mean"].get<std::vector<double>>();
    const auto scale = map_["scale"].get<std::vector<double>>();
    std::vector<double> least, most;
    for (std::size_t j = 0; j < mean.size(); ++j) {
      const double reach = width * std::max(scale[j], 1e-12);
      least.push_back(mean[j] - reach);
      most.push_back(mean[j] + reach);
    }
    const auto low = graph.node("Max", {"features", row(graph, floats(least))});
    return graph.node("Min", {low, row(graph, floats(most))});
  }

  std::vector<float> inverse_scale() const {
    std::vector<double> inverse;
    for (const double sd : map_["scale"].get<std::vector<double>>()) {
      const double scale = map_["variance"].get<bool>() ? sd * sd : sd;
      inverse.push_back(sd < 1e-12 ? 1.0 : 1.0 / scale);
    }
    return floats(inverse);
  }

  /// Each feature of a window by its mean and deviation.
  std::string standardised(Graph& graph) const {
    std::vector<double> inverse;
    for (const double sd : map_["deviation"].get<std::vector<double>>()) {
      inverse.push_back(sd < 1e-12 ? 1.0 : 1.0 / sd);
    }
    return product(graph, difference(graph, "features", numbers(map_, "mean")), floats(inverse));
  }

  std::string name_;
  Container file_;
  Json map_;
};

}  // namespace

std::string to_onnx(const Network& network, bool carries) {
  Graph graph;
  const std::string result = onnx::add_layers(network, graph, "input", carries);
  return graph.file("input", onnx::sample_shape(network), result, "output",
                    network.shapes().back());
}

std::string to_onnx(const Identifier& identifier) {
  require(!identifier.base, Exit::kUsage,
          "this model adds to a simulator, which ONNX does not hold; train it without --base");
  const std::optional<Network> network = identifier.model->network();
  require(network.has_value(), Exit::kUsage, "a ", identifier.name,
          " is no plain network and cannot be written as ONNX; kinds that can: dcnn, lstm, "
          "lstm-25, mlp, ffnn-s, ffnn-m");
  const Around around(identifier);
  Graph graph;
  Shape sample;
  const std::string input = around.before(graph, sample);
  const std::string y = onnx::add_layers(*network, graph, input);
  const std::string result = around.after(graph, y);
  return graph.file("features", sample, result, "targets", network->shapes().back());
}

}  // namespace dcnn
