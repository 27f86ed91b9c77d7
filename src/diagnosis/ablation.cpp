// SPDX-License-Identifier: Apache-2.0
#include "dcnn/diagnosis/ablation.h"

#include <utility>

#include "dcnn/core/error.h"
#include "dcnn/physics/effect.h"

namespace dcnn {
namespace {

const std::vector<std::pair<const char*, bool Ablation::*>>& parts_by_name() {
  static const std::vector<std::pair<const char*, bool Ablation::*>> parts{
      {"refinement", &Ablation::refinement},
      {"exact-operators", &Ablation::exact_operators},
      {"projection", &Ablation::projection},
      {"smoothing", &Ablation::smoothing},
      {"coloured-floor", &Ablation::coloured_floor},
      {"omnibus", &Ablation::omnibus},
      {"exchange", &Ablation::exchange},
      {"flips", &Ablation::flips}};
  return parts;
}

}  // namespace

std::vector<std::string> Ablation::names() const {
  std::vector<std::string> names;
  for (const auto& [name, part] : parts_by_name()) {
    if (this->*part) names.emplace_back(name);
  }
  names.insert(names.end(), effects.begin(), effects.end());
  return names;
}

const std::vector<std::string>& ablations() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, part] : parts_by_name()) all.emplace_back(name);
    for (const EffectKind* kind : effect_kinds()) all.push_back(kind->name);
    return all;
  }();
  return names;
}

Ablation ablation_of(const std::vector<std::string>& parts) {
  Ablation ablation;
  for (const std::string& wanted : parts) {
    bool known = false;
    for (const auto& [name, part] : parts_by_name()) {
      if (wanted == name) ablation.*part = known = true;
    }
    if (find_effect(wanted) != nullptr) {
      ablation.effects.insert(wanted);
      known = true;
    }
    require(known, Exit::kUsage, "'", wanted,
            "' is no part of the diagnosis and no effect to leave out");
  }
  return ablation;
}

}  // namespace dcnn
