// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/network_model.h"

namespace dcnn {
namespace {

/// One hidden layer on the newest row (or any other network input), linear outputs.
Json mlp_layers(Options options, Index targets) {
  const auto hidden = static_cast<Index>(options.number("hidden", 64, 1, 4096));
  const auto activation = options.choice("activation", "tanh", {"tanh", "relu"});
  const double dropout = options.number("dropout", 0.0, 0.0, 0.95);
  for (const char* key : {"name", "input"}) options.raw(key);
  options.finish();
  Json layers = {
      {{"kind", "flatten"}}, {{"kind", "linear"}, {"outputs", hidden}}, {{"kind", activation}}};
  if (dropout > 0.0) layers.push_back({{"kind", "dropout"}, {"rate", dropout}});
  layers.push_back({{"kind", "linear"}, {"outputs", targets}});
  return layers;
}

/// Spec 2.6, row mlp; batches and schedule as those of the DCNN. The paper has none: its preset is
/// that of `fair`.
Json mlp_preset(const std::string& preset, bool axes) {
  Json training = {{"epochs", 30},
                   {"batch", axes ? 200 : 50},
                   {"lr", 1e-3},
                   {"drop_factor", 0.1},
                   {"drop_period", 20},
                   {"l2", 1e-4},
                   {"standardise_targets", true}};
  if (preset == "quick") training["epochs"] = 5;
  if (preset == "fair" || preset == "paper") {
    training.update({{"epochs", 60}, {"drop_period", 40}});
  }
  return {{"map", {{"sigma_floor", 0.01}}},
          {"model", {{"hidden", 64}, {"activation", "tanh"}}},
          {"training", std::move(training)}};
}

std::unique_ptr<Model> make_mlp(const Problem& problem) {
  Options options(problem.configuration, problem.where, Exit::kUsage);
  Options model = options.child("model");
  const Json input = model.raw("input");
  return std::make_unique<NetworkModel>(
      "mlp", input.is_null() ? Json{{"kind", "window"}, {"length", 1}} : input,
      mlp_layers(model, problem.outputs()), problem);
}

std::unique_ptr<Model> load_network(const Container& file, const std::string& where) {
  return std::make_unique<NetworkModel>(file, where);
}

}  // namespace

extern const ModelKind mlp_model;
const ModelKind mlp_model{"mlp",
                          "one layer of 64 units on the standardised features, Adam (not the "
                          "paper's: preset paper is fair)",
                          mlp_preset,
                          make_mlp,
                          load_network,
                          true};

}  // namespace dcnn
