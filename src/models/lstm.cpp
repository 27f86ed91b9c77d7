// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/network_model.h"

namespace dcnn {
namespace {

/// Spec 2.5: an LSTM over a window of rows that ends at the present one, dropout on its newest
/// output, a fully connected layer.
Json lstm_layers(Options& options, Index targets) {
  const auto units = options.get<Index>("units", 150);
  const auto init = options.choice("init", "glorot", {"glorot", "narrow"});
  const double dropout = options.number("dropout", 0.5, 0.0, 0.95);
  Json layers = {{{"kind", "lstm"}, {"units", units}, {"init", init}}};
  if (dropout > 0.0) layers.push_back({{"kind", "dropout"}, {"rate", dropout}});
  layers.push_back({{"kind", "linear"}, {"outputs", targets}, {"init", init}});
  return layers;
}

/// What the presets of both kinds share. The paper's rate of 0.2 saturates the gates under Adam
/// (decision D13); everywhere else it is 0.005.
Json shared_preset(const std::string& preset, bool axes) {
  Json json = {{"map", {{"sigma_floor", 0.01}}},
               {"model", {{"units", 150}, {"dropout", 0.5}, {"init", "glorot"}}},
               {"training",
                {{"batch", 200},
                 {"lr", 5e-3},
                 {"drop_factor", 0.5},
                 {"drop_period", 100},
                 {"l2", 1e-4},
                 {"clip", 1.0},
                 {"standardise_targets", true}}}};
  if (preset == "paper") {
    json["training"].update({{"epochs", 300},
                             {"lr", 0.2},
                             {"standardise_targets", false},
                             {"keep", "last"},
                             {"validation", 0.0}});
    json["model"]["init"] = "narrow";
    json["map"]["sigma_floor"] = 0.0;
  } else if (axes) {
    json["model"]["dropout"] = 0.0;
  }
  return json;
}

/// Spec 2.6, row lstm: one step, as in the paper, but in `fair`.
Json lstm_preset(const std::string& preset, bool axes) {
  Json json = shared_preset(preset, axes);
  json["model"]["length"] = preset == "fair" ? 25 : 1;
  if (preset == "quick") json["training"]["epochs"] = 5;
  if (preset == "standard") json["training"]["epochs"] = 30;
  if (preset == "fair") json["training"]["epochs"] = 60;
  return json;
}

/// Spec 2.6, row lstm-25. `quick` is no part of the quick reproduction; it is a first look.
Json lstm_25_preset(const std::string& preset, bool axes) {
  Json json = shared_preset(preset, axes);
  json["model"]["length"] = 25;
  Json& training = json["training"];
  if (preset == "quick") training.update({{"epochs", 1}, {"stride", 10}});
  if (preset == "standard") training.update({{"epochs", 10}, {"stride", 5}});
  if (preset == "fair") training["epochs"] = 60;
  return json;
}

std::unique_ptr<Model> make_network(const std::string& kind, Index length, const Problem& problem) {
  Options all(problem.configuration, problem.where, Exit::kUsage);
  Options options = all.child("model");
  options.get<std::string>("name", kind);
  const Json window = {{"kind", "window"}, {"length", options.get("length", length)}};
  const Json layers = lstm_layers(options, problem.outputs());
  options.finish();
  return std::make_unique<NetworkModel>(kind, window, layers, problem);
}

std::unique_ptr<Model> make_lstm(const Problem& problem) {
  return make_network("lstm", 1, problem);
}
std::unique_ptr<Model> make_lstm_25(const Problem& problem) {
  return make_network("lstm-25", 25, problem);
}

}  // namespace

extern const ModelKind lstm_model, lstm_25_model;
const ModelKind lstm_model{"lstm", "LSTM of 150 units on the present row alone, as in the paper",
                           lstm_preset, make_lstm, NetworkModel::load};
const ModelKind lstm_25_model{"lstm-25", "LSTM of 150 units on the last 25 rows", lstm_25_preset,
                              make_lstm_25, NetworkModel::load};

}  // namespace dcnn
