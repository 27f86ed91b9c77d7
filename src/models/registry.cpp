// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/model.h"

namespace dcnn {

#define MODEL(kind) extern const ModelKind kind##_model;
#include "models/models.def"
#undef MODEL

std::vector<const ModelKind*> model_kinds() {
  return {
#define MODEL(kind) &kind##_model,
#include "models/models.def"
#undef MODEL
  };
}

const ModelKind& model_kind(const std::string& name, Exit exit) {
  std::vector<std::string> names;
  for (const ModelKind* kind : model_kinds()) {
    if (kind->name == name) return *kind;
    names.emplace_back(kind->name);
  }
  const auto near = nearest_word(name, names);
  fail(exit, "unknown model '", name, "'",
       near.empty() ? "; see --help for the list" : "; did you mean '" + near + "'?");
}

}  // namespace dcnn
