// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/network_model.h"

namespace dcnn {
namespace {

/// The network of Su et al. 2020: four modules of 2x2 convolution, batch norm and ReLU with 8, 16,
/// 32 and 32 filters on the map of Eq. 7, dropout on the flattened maps, a fully connected layer.
Json dcnn_layers(Options options, Index targets, Index features) {
  const auto padding = options.choice("padding", "same", {"same", "valid"});
  const auto filters = options.get("filters", std::vector<Index>{8, 16, 32, 32});
  const auto init = options.choice("init", "glorot", {"glorot", "narrow"});
  const double dropout = options.number("dropout", 0.5, 0.0, 0.95);
  options.get<std::string>("name", "dcnn");
  options.finish();
  const auto least = static_cast<Index>(filters.size()) + 1;
  if (padding == "valid" && (features < least || InputMap::kColumns < least)) {
    options.reject("padding", "is 'valid', which needs at least ", least, " rows and columns, not ",
                   features, "x", InputMap::kColumns, "; use 'same'");
  }
  Json layers = Json::array();
  for (const Index count : filters) {
    layers.push_back({{"kind", "conv2d"},
                      {"filters", count},
                      {"window", {2, 2}},
                      {"padding", padding},
                      {"init", init}});
    layers.push_back({{"kind", "batch_norm"}});
    layers.push_back({{"kind", "relu"}});
  }
  if (dropout > 0.0) layers.push_back({{"kind", "dropout"}, {"rate", dropout}});
  layers.push_back({{"kind", "flatten"}});
  layers.push_back({{"kind", "linear"}, {"outputs", targets}, {"init", init}});
  return layers;
}

/// Dropout and weight averaging are chosen on the validation rows.
Json fair_candidates() {
  Json list = Json::array();
  for (const double dropout : {0.5, 0.25, 0.0}) {
    for (const double ema : {0.0, 0.998}) {
      list.push_back({{"model", {{"dropout", dropout}}}, {"training", {{"ema", ema}}}});
    }
  }
  return list;
}

/// Spec 2.6: row dcnn, and the rule for --system data.
Json dcnn_preset(const std::string& preset, bool axes) {
  Json json = {{"map", {{"sigma_floor", 0.01}}},
               {"model", {{"padding", "same"}, {"dropout", 0.5}, {"init", "glorot"}}},
               {"training",
                {{"epochs", 30},
                 {"batch", 50},
                 {"lr", 1e-3},
                 {"drop_factor", 0.1},
                 {"drop_period", 20},
                 {"l2", 1e-4},
                 {"standardise_targets", true}}}};
  Json& training = json["training"];
  if (preset == "quick") training["epochs"] = 5;
  if (preset == "fair") {
    training["epochs"] = 60;
    training["drop_period"] = 40;
    training["candidates"] = fair_candidates();
  }
  if (preset == "paper") {
    training.update({{"epochs", 500},
                     {"drop_factor", 0.001},
                     {"drop_period", 300},
                     {"standardise_targets", false},
                     {"keep", "last"},
                     {"validation", 0.0}});
    json["model"]["init"] = "narrow";
    json["map"]["sigma_floor"] = 0.0;
  } else if (axes) {
    json["model"]["dropout"] = 0.0;
    training["batch"] = 200;
  }
  return json;
}

std::unique_ptr<Model> make_dcnn(const Problem& problem) {
  Options options(problem.configuration, problem.where, Exit::kUsage);
  const Json layers = dcnn_layers(options.child("model"), problem.outputs(), problem.features());
  return std::make_unique<NetworkModel>("dcnn", Json{{"kind", "map"}}, layers, problem);
}

}  // namespace

extern const ModelKind dcnn_model;
const ModelKind dcnn_model{"dcnn", "the paper's deep convolutional network (four 2x2 modules)",
                           dcnn_preset, make_dcnn, NetworkModel::load};

}  // namespace dcnn
