// SPDX-License-Identifier: Apache-2.0
#include "conceal/tally.h"

#include <algorithm>
#include <cmath>

#include "conceal/draws.h"

namespace dcnn::conceal {

Json wilson(int k, int n) {
  Json out{{"k", k}, {"n", n}, {"rate", nullptr}, {"low", nullptr}, {"high", nullptr}};
  if (n == 0) return out;
  constexpr double z = 1.959964;
  const double p = static_cast<double>(k) / n, zz = z * z / n;
  const double middle = (p + 0.5 * zz) / (1.0 + zz);
  const double half = std::sqrt(z * z * p * (1.0 - p) / n + 0.25 * zz * zz) / (1.0 + zz);
  out["rate"] = p;
  out["low"] = std::max(0.0, middle - half);
  out["high"] = std::min(1.0, middle + half);
  return out;
}

void Tally::count(const std::string& name, bool yes) {
  auto& [k, n] = rates_[name];
  k += yes ? 1 : 0;
  ++n;
}

void Tally::add(const std::string& name, double value) {
  if (std::isfinite(value)) values_[name].push_back(value);
}

Json Tally::summary() const {
  Json out = Json::object();
  for (const auto& [name, rate] : rates_) out[name] = wilson(rate.first, rate.second);
  for (const auto& [name, values] : values_) {
    std::vector<double> v = values;
    std::sort(v.begin(), v.end());
    const auto quantile = [&](double q) {
      return v[static_cast<std::size_t>(std::lround(q * static_cast<double>(v.size() - 1)))];
    };
    out[name] = {{"n", v.size()},
                 {"median", quantile(0.5)},
                 {"p90", quantile(0.9)},
                 {"p95", quantile(0.95)},
                 {"max", v.back()}};
  }
  return out;
}

Json confidence_table(const Json& scenarios) {
  static const std::vector<double> edges{0.0, 0.5, 0.7, 0.85, 0.95, 1.0};
  struct Bin {
    int n = 0, right = 0;
    double said = 0.0;
  };
  std::vector<Bin> bins(edges.size() - 1);
  Bin all;
  double brier = 0.0;
  for (const Json& s : scenarios) {
    for (const Json& c : s.value("confidences", Json::array())) {
      const double said = c["said"];
      const bool right = c["right"];
      std::size_t k = 0;
      while (k + 2 < edges.size() && said >= edges[k + 1]) ++k;
      for (Bin* bin : {&bins[k], &all}) {
        ++bin->n, bin->right += right ? 1 : 0, bin->said += said;
      }
      brier += (said - right) * (said - right);
    }
  }
  if (all.n == 0) return nullptr;
  Json out{{"n", all.n},
           {"said", all.said / all.n},
           {"right", static_cast<double>(all.right) / all.n},
           {"brier", brier / all.n},
           {"bins", Json::array()}};
  for (std::size_t k = 0; k < bins.size(); ++k) {
    if (bins[k].n == 0) continue;
    const Json rate = wilson(bins[k].right, bins[k].n);
    out["bins"].push_back({{"from", edges[k]},
                           {"to", edges[k + 1]},
                           {"n", bins[k].n},
                           {"said", bins[k].said / bins[k].n},
                           {"right", rate["rate"]},
                           {"low", rate["low"]},
                           {"high", rate["high"]}});
  }
  return out;
}

void add_effect(const Json& e, Tally& tally) {
  if (!e["listed"].get<bool>()) return;
  if (e.contains("kind_named")) tally.count("found_kind", e["kind_named"]);
  tally.count("found", e["named"]);
  tally.count("found_class", e["in_class"]);
  if (e["axis_right"].is_boolean()) tally.count("axis", e["axis_right"]);
  if (e["interval_overlap"].is_number()) tally.add("interval_overlap", e["interval_overlap"]);
  for (const auto& [name, p] : e["parameters"].items()) {
    if (p["covered"].is_boolean()) tally.count("coverage", p["covered"]);
    tally.add("parameter_error", p["error"]);
  }
}

constexpr double kLittle = 0.05;  // of the hidden force

void add_holdout(const Json& s, Tally& tally) {
  const Json& h = s["holdout"];
  if (!h.contains("oracle")) return;
  for (const char* key : {"before", "after", "floor"}) {
    if (!h.contains(key)) continue;
    tally.add(std::string(key) + "_over_oracle", h[key].get<double>() / h["oracle"].get<double>());
  }
  if (!h.contains("before") || !h.contains("after")) return;
  const double before = h["before"], after = h["after"], oracle = h["oracle"];
  const bool within = after <= kWithin * oracle;
  tally.count("holdout_within", within);
  for (const Json& law : s["laws"]) {
    if (law.value("established", false)) tally.count("law_within", within);
  }
  // Errors and noise are independent: their mean squares add up.
  const double hidden = before * before - oracle * oracle;
  if (s["hidden"].empty() || !(hidden > 0.0)) return;
  const double left = std::sqrt(std::max(0.0, after * after - oracle * oracle) / hidden);
  tally.add("force_left", left);
  tally.count("force_within", left <= kLittle);
}

void add_scenario(const Json& s, Tally& tally) {
  if (s["seconds"].is_number()) tally.add("seconds", s["seconds"]);
  if (s.value("fit_only", false)) return add_holdout(s, tally);
  const std::string group = s["group"];
  const int named = static_cast<int>(s["named"].size()), wrong = s["false_names"];
  tally.count("verdict", s["verdict_right"]);
  tally.count("ran", s["verdict"] != "failed");
  for (int k = 0; k < named; ++k) tally.count("false_discovery", k < wrong);
  if (has("null faint", group)) {
    tally.count("null_specificity", wrong == 0 && s["verdict"] == "consistent");
    tally.count("null_without_name", wrong == 0 && s["verdict"] != "failed");
  } else if (has("unlisted law", group)) {
    tally.count("abstention", wrong == 0 && s["verdict"] != "failed");
  } else {
    tally.count("set", s["set"]);
    tally.count("class_set", s["class_set"]);
    tally.count("top1", s["top1"]);
  }
  if (group != "faint") {
    for (const Json& e : s["effects"]) add_effect(e, tally);
  }
  add_holdout(s, tally);
  const Json& h = s["holdout"];
  if (h.contains("after") && h.contains("floor")) {
    tally.add("after_over_floor", h["after"].get<double>() / h["floor"].get<double>());
  }
}

}  // namespace dcnn::conceal
