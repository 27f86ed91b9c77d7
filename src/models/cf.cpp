// SPDX-License-Identifier: Apache-2.0
#include "models/linear_model.h"

namespace dcnn {
namespace {

const std::vector<LinearModel::Form> kForms = {{"gravity", Terms::kGravity, 0.0},
                                               {"fourier", Terms::kFourier, 1e-8}};

Json preset_cf(const std::string& name, bool /*axes*/) {
  Json json = closed_form_preset(name);
  json["model"] = {{"form", "gravity"}};
  return json;
}

std::unique_ptr<Model> make_cf(const Problem& problem) {
  Options options(problem.configuration, problem.where, Exit::kUsage);
  Options model = options.child("model");
  const std::string name = model.choice("form", "gravity", {"gravity", "fourier"});
  model.raw("name");
  model.finish();
  return std::make_unique<LinearModel>("cf", kForms[name == "gravity" ? 0 : 1], problem);
}

std::unique_ptr<Model> load_cf(const Container& file, const std::string& where) {
  return std::make_unique<LinearModel>(file, kForms, where);
}

}  // namespace

extern const ModelKind cf_model;
const ModelKind cf_model{"cf",      "curve fitting: the force as a function of the orientation",
                         preset_cf, make_cf,
                         load_cf,   true};

}  // namespace dcnn
