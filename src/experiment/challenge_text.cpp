// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>

#include "dcnn/experiment/challenge_report.h"
#include "experiment/challenge_tables.h"
#include "experiment/markup.h"

namespace dcnn {
namespace {

const Columns kHeadline{{"top1", "first name is right"},
                        {"set", "all named, nothing else"},
                        {"class_set", "the same, alternatives count"},
                        {"found", "effects named"},
                        {"found_class", "effects named or among the alternatives"},
                        {"found_kind", "effects of which the kind of law is named"},
                        {"false_discovery", "false names among all names"},
                        {"null_specificity", "\"consistent\" where nothing is hidden"},
                        {"null_without_name", "no name where nothing is hidden"},
                        {"abstention", "no name for what has none"},
                        {"verdict", "verdict right"},
                        {"axis", "axis right"},
                        {"interval_overlap", "overlap of intervals"},
                        {"parameter_error", "relative error of a number"},
                        {"coverage", "truth within the 95 % interval"},
                        {"after_over_oracle", "hold-out error over the true law's"},
                        {"holdout_within", "hold-out error at most 1.05 of the true law's"},
                        {"law_within", "the same, of laws that are called established"},
                        {"force_left", "hidden force that is left, as a share"},
                        {"force_within", "at most 5 % of it left"},
                        {"after_over_floor", "hold-out error over the estimated floor"},
                        {"seconds", "seconds a scenario"},
                        {"ran", "ended without an error"}};

std::string text_of(const char* format, double a, double b = 0.0, double c = 0.0) {
  char text[96];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

/// One method a row, rates in per cent, medians.
std::string comparison_text(const Json& table) {
  const Columns columns{{"top1", "first"},
                        {"set", "set"},
                        {"class_set", "class"},
                        {"false_discovery", "false"},
                        {"null_without_name", "nulls"},
                        {"verdict", "verdict"},
                        {"after_over_oracle", "hold-out"},
                        {"seconds", "seconds"}};
  std::string text(28, ' ');
  for (const auto& [key, heading] : columns)
    text += std::string(10 - heading.size(), ' ') + heading;
  for (const auto& [label, rates] : table.items()) {
    std::string line = label;
    line.resize(28, ' ');
    for (const auto& [key, heading] : columns) {
      const Json value = rates.value(key, Json());
      std::string said;
      if (value.contains("rate") && !value["rate"].is_null()) {
        said = text_of("%.0f %%", 100.0 * value["rate"].get<double>());
      } else if (value.contains("median")) {
        said = text_of("%.4g", value["median"]);
      }
      line += std::string(10 - std::min<std::size_t>(10, said.size()), ' ') + said;
    }
    text += "\n" + line;
  }
  return text + "\n";
}

/// How many of each effect alone were named (or were among the alternatives), by amplitude.
std::string singles_text(const Json& table) {
  std::set<double> amplitudes;
  for (const auto& [effect, cells] : table.items()) {
    for (const auto& [amplitude, cell] : cells.items()) amplitudes.insert(std::stod(amplitude));
  }
  std::string text = "alone, named (class) of         ";
  for (const double a : amplitudes) text += text_of("%14g", a);
  for (const auto& [effect, cells] : table.items()) {
    std::string line = effect;
    line.resize(32, ' ');
    for (const double a : amplitudes) {
      std::string said;
      for (const auto& [amplitude, cell] : cells.items()) {
        if (std::stod(amplitude) != a) continue;
        said = cell["named"].dump() + " (" + cell["in_class"].dump() + ") of " + cell["of"].dump();
      }
      line += std::string(14 - std::min<std::size_t>(14, said.size()), ' ') + said;
    }
    text += "\n" + line;
  }
  return text + "\n";
}

/// How probable names were said to be, and how often they were right.
std::string confidence_text(const Json& table) {
  std::string text =
      text_of("confidence of names: said %.2f, right %.2f, ", table["said"], table["right"]) +
      text_of("Brier score %.3f", table["brier"]) + " of " + table["n"].dump();
  for (const Json& bin : table["bins"]) {
    text += text_of("\n    %.2f to %.2f: said %.2f, ", bin["from"], bin["to"], bin["said"]) +
            text_of("right %.2f [%.2f, %.2f]", bin["right"], bin["low"], bin["high"]) + " of " +
            bin["n"].dump();
  }
  return text + "\n";
}

/// What was hidden and what was said of it.
std::string story(const Json& s) {
  std::string hidden;
  for (const Json& e : s["effects"]) {
    hidden += (hidden.empty() ? "" : ", ") + e["effect"].get<std::string>() +
              text_of(" (%.2g of the noise)", e["amplitude"]);
  }
  std::string text = s["id"].get<std::string>() +
                     "  hidden:  " + (hidden.empty() ? "nothing" : hidden) +
                     "\n       named:   " + joined_names(s["named"]) +
                     "\n       verdict: " + s["verdict"].get<std::string>() + "\n";
  const Json& error = s["holdout"];
  if (error.contains("after") && error.contains("oracle")) {
    text += text_of("       held-out error %.3g N, with what was found %.3g N; ", error["before"],
                    error["after"]) +
            text_of("the true law fitted leaves %.3g N\n", error["oracle"]);
  }
  return text;
}

}  // namespace

std::string joined_names(const Json& names) {
  std::string text;
  for (const Json& name : names) text += (text.empty() ? "" : ", ") + name.get<std::string>();
  return text.empty() ? "nothing" : text;
}

std::vector<std::vector<std::string>> headline_rows(const Json& scores) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [key, heading] : kHeadline) {
    const std::string value = score_text(scores["tables"]["all"].value(key, Json()));
    if (!value.empty()) rows.push_back({heading, value});
  }
  return rows;
}

namespace {

/// Three decimals of a ratio near 1, two digits of an error.
std::string plain(double value) { return text_of(std::abs(value) < 0.1 ? "%.2g" : "%.4g", value); }

}  // namespace

std::string score_text(const Json& value) {
  if (value.is_null()) return "";
  if (value.contains("rate")) {
    if (value["rate"].is_null()) return "";
    return text_of("%.0f %% [%.0f, %.0f]", 100.0 * value["rate"].get<double>(),
                   100.0 * value["low"].get<double>(), 100.0 * value["high"].get<double>()) +
           " of " + value["n"].dump();
  }
  constexpr double kLeast = 1e-4;  // below which a median is as good as nothing
  const double median = value["median"], most = value["p90"];
  const std::string below = "90 % below " + plain(std::max(most, kLeast));
  return (median < kLeast ? "below 0.0001" : plain(median)) + ", " + below;
}

Json beside_rivals(const Json& scores) {
  Json table{{"dcnn-diagnose", scores["tables"]["all"]}};
  table.update(scores["rivals"]);
  for (const auto& [method, rates] : scores["rivals"].items()) table[method].erase("verdict");
  table["the true law"] = {{"after_over_oracle", {{"median", 1.0}, {"p90", 1.0}}}};
  return table;
}

Json beside_ablations(const Json& scores) {
  Json table{{"complete", scores["tables"]["all"]}};
  for (const auto& [part, rates] : scores["ablations"].items()) table["without " + part] = rates;
  return table;
}

std::string challenge_text(const Json& scores) {
  std::string text = std::to_string(scores["scenarios"].size()) + " scenarios of seed " +
                     scores["seed"].dump() + ", sealed " + scores["sha256"].get<std::string>() +
                     "\n";
  constexpr std::size_t kFew = 5;
  if (scores["scenarios"].size() <= kFew) {
    for (const Json& s : scores["scenarios"]) text += story(s);
    return text;
  }
  for (const auto& row : headline_rows(scores)) text += padded(row[0], 46) + row[1] + "\n";
  if (!scores["missing"].empty()) {
    text += std::to_string(scores["missing"].size()) + " scenarios are not yet run\n";
  }
  text += "\n" + comparison_text(scores["tables"]["group"]);
  const Json confidence = scores["tables"].value("confidence", Json());
  if (!confidence.is_null()) text += "\n" + confidence_text(confidence);
  if (scores["tables"]["family"].size() > 1) {
    text += "\n" + comparison_text(scores["tables"]["family"]);
  }
  const Json& single = scores["tables"]["single"];
  if (single.size() > 1) {
    text += "\n" + comparison_text(single) + "\n" + singles_text(scores["tables"]["single_effect"]);
  }
  if (!scores["rivals"].empty()) text += "\n" + comparison_text(beside_rivals(scores));
  if (!scores["ablations"].empty()) text += "\n" + comparison_text(beside_ablations(scores));
  return text;
}

}  // namespace dcnn
