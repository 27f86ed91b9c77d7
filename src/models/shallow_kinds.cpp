// SPDX-License-Identifier: Apache-2.0
// The paper's four networks trained by Levenberg-Marquardt (Su et al. 2020): 383, 225, 428 and 387
// parameters on 15 inputs.
#include "models/shallow_model.h"

namespace dcnn {
namespace {

/// Spec 2.6, row ffnn, cfnn. Several units of measure cannot share one error: axes are weighed by
/// their spread.
Json preset_of(const std::string& preset, bool axes, std::vector<Index> hidden) {
  Json training = {
      {"epochs", 200}, {"stride", 1}, {"division", "random"}, {"standardise_targets", axes}};
  if (preset == "quick") training.update({{"epochs", 30}, {"stride", 8}});
  if (preset == "fair") training.update({{"epochs", 1000}, {"division", "held-out"}});
  if (preset == "paper") training.update({{"epochs", 1000}, {"validation", 0.0}});
  return {{"model", {{"hidden", std::move(hidden)}, {"inputs", "all"}}},
          {"training", std::move(training)}};
}

Json small_preset(const std::string& preset, bool axes) { return preset_of(preset, axes, {20}); }
Json medium_preset(const std::string& preset, bool axes) { return preset_of(preset, axes, {9, 6}); }

std::unique_ptr<Model> make_ffnn_s(const Problem& problem) {
  return std::make_unique<ShallowModel>("ffnn-s", false, problem);
}
std::unique_ptr<Model> make_ffnn_m(const Problem& problem) {
  return std::make_unique<ShallowModel>("ffnn-m", false, problem);
}
std::unique_ptr<Model> make_cfnn_s(const Problem& problem) {
  return std::make_unique<ShallowModel>("cfnn-s", true, problem);
}
std::unique_ptr<Model> make_cfnn_m(const Problem& problem) {
  return std::make_unique<ShallowModel>("cfnn-m", true, problem);
}
std::unique_ptr<Model> load_shallow(const Container& file, const std::string& where) {
  return std::make_unique<ShallowModel>(file, where);
}

}  // namespace

extern const ModelKind ffnn_s_model, ffnn_m_model, cfnn_s_model, cfnn_m_model;
const ModelKind ffnn_s_model{"ffnn-s",     "feed-forward, 20 tanh units, Levenberg-Marquardt",
                             small_preset, make_ffnn_s,
                             load_shallow, true};
const ModelKind ffnn_m_model{"ffnn-m",      "feed-forward, 9 and 6 tanh units, Levenberg-Marquardt",
                             medium_preset, make_ffnn_m,
                             load_shallow,  true};
const ModelKind cfnn_s_model{"cfnn-s", "cascade-forward, 20 tanh units, Levenberg-Marquardt",
                             small_preset, make_cfnn_s, load_shallow};
const ModelKind cfnn_m_model{"cfnn-m", "cascade-forward, 9 and 6 tanh units, Levenberg-Marquardt",
                             medium_preset, make_cfnn_m, load_shallow};

}  // namespace dcnn
