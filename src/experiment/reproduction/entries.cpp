// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/entries.h"

#include <algorithm>
#include <set>

#include "dcnn/models/model.h"

namespace dcnn {
namespace {

using Group = Entry::Group;

/// Order of the paper's Fig. 5; angles alone are the inputs of the authors' earlier works.
std::vector<Entry> known_entries() {
  const Json angles = {{"model", {{"inputs", "angles"}}}},
             valid = {{"model", {{"padding", "valid"}}}};
  return {
      {"ns", "NS", "ns", {}, Group::kPaper, 0, 0, 6},
      {"cf", "CF", "cf", {}, Group::kPaper, 0.1, 0.05, 1},
      {"ffnn-s", "FFNN-S", "ffnn-s", {}, Group::kPaper, 7, 0.03, 2},
      {"cfnn-s", "CFNN-S", "cfnn-s", {}, Group::kPaper, 8, 0.03, 3},
      {"ffnn-m", "FFNN-M", "ffnn-m", {}, Group::kPaper, 6, 0.03, 4},
      {"cfnn-m", "CFNN-M", "cfnn-m", {}, Group::kPaper, 9, 0.03, 5},
      {"lstm", "LSTM", "lstm", {}, Group::kPaper, 5, 0.03, 11},
      {"lstm-25", "LSTM-25", "lstm-25", {}, Group::kReading, 10, 1, 14, true},
      {"dcnn", "DCNN", "dcnn", {}, Group::kPaper, 86, 0.1, 0},
      {"dcnn-valid", "DCNN valid", "dcnn", valid, Group::kReading, 50, 0.05, 8},
      {"ffnn-s-angles", "FFNN-S angles", "ffnn-s", angles, Group::kReading, 4, 0.03, 10},
      {"cfnn-m-angles", "CFNN-M angles", "cfnn-m", angles, Group::kReading, 6, 0.03, 15},
      {"rigid", "rigid", "rigid", {}, Group::kOwn, 0.1, 0.05, 6},
      {"rls", "RLS", "rls", {}, Group::kOwn, 0.1, 0.05, 10},
      {"mlp", "MLP", "mlp", {}, Group::kOwn, 8, 0.03, 12},
      {"dcnn-plus", "DCNN+", "dcnn-plus", {}, Group::kOwn, 3, 0.35, 9},
      {"dcnn-t", "DCNN+T", "dcnn-t", {}, Group::kOwn, 12, 0.22, 13, true},
      {"frame-tcn", "Frame-TCN", "frame-tcn", {}, Group::kOwn, 13, 0.18, 7, true},
  };
}

bool registered(const std::string& kind) {
  const auto kinds = model_kinds();
  return kind == kNoIdentification ||
         std::any_of(kinds.begin(), kinds.end(), [&](const auto* k) { return k->name == kind; });
}

/// Known entries whose kind exists, then kinds that are registered and not known here.
std::vector<Entry> available_entries() {
  std::vector<Entry> entries = known_entries();
  std::erase_if(entries, [](const Entry& entry) { return !registered(entry.kind); });
  for (const ModelKind* kind : model_kinds()) {
    const bool known = std::any_of(entries.begin(), entries.end(),
                                   [&](const Entry& entry) { return entry.kind == kind->name; });
    if (!known) entries.push_back({kind->name, kind->name, kind->name, {}, Group::kOwn, 30, 1, 15});
  }
  return entries;
}

}  // namespace

std::vector<Entry> choose_entries(const std::vector<std::string>& wanted,
                                  const std::string& preset) {
  std::vector<Entry> entries = available_entries();
  std::vector<std::string> names;
  for (const Entry& entry : entries) names.push_back(entry.name);
  for (const auto& name : wanted) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const auto near = nearest_word(name, names);
    fail(Exit::kUsage, "--models: unknown model '", name, "'",
         near.empty() ? "" : "; did you mean '" + near + "'?");
  }
  const std::set<std::string> chosen(wanted.begin(), wanted.end());
  std::erase_if(entries, [&](const Entry& entry) {
    if (entry.name == kNoIdentification) return false;
    if (!chosen.empty()) return !chosen.contains(entry.name);
    return preset == "quick" && entry.name == "lstm-25";  // minutes of training and of prediction
  });
  return entries;
}

bool timed(const Entry& entry) {
  return entry.name != kNoIdentification && entry.name.find("angles") == std::string::npos;
}

}  // namespace dcnn
