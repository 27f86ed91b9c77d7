// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>

#include "conceal/axis_world.h"
#include "conceal/draws.h"
#include "conceal/tally.h"
#include "dcnn/conceal/challenge.h"

namespace dcnn::conceal {
namespace {

bool holds(const Json& list, const std::string& id) {
  return std::find(list.begin(), list.end(), id) != list.end();
}

/// Whether a finding has the effect's name, or one that the answers declare to say the same.
bool is_name_of(const Json& hidden, const Json& finding) {
  const std::string said = finding["effect"];
  return said == hidden["effect"] || holds(hidden.value("aliases", Json::array()), said);
}

bool is_hidden(const Json& hidden, const Json& finding) {
  return std::any_of(hidden.begin(), hidden.end(),
                     [&](const Json& h) { return is_name_of(h, finding); });
}

/// For every hidden effect the finding that names it (on its axis before others), or has it among
/// the alternatives where no finding names it; each finding serves once.
std::vector<const Json*> matched(const Json& hidden, const Json& findings) {
  std::vector<const Json*> match(hidden.size(), nullptr);
  std::vector<bool> used(findings.size(), false);
  enum class By { kNameAndAxis, kName, kAlternative };
  for (const By by : {By::kNameAndAxis, By::kName, By::kAlternative}) {
    for (std::size_t h = 0; h < hidden.size(); ++h) {
      const std::string id = hidden[h]["effect"];
      for (std::size_t k = 0; k < findings.size() && match[h] == nullptr; ++k) {
        const Json& f = findings[k];
        const bool fits =
            by == By::kAlternative ? holds(f["alternatives"], id) : is_name_of(hidden[h], f);
        const bool there = by != By::kNameAndAxis || f["axis"] == hidden[h]["axis"];
        if (used[k] || !fits || !there) continue;
        match[h] = &f;
        used[k] = true;
      }
    }
  }
  return match;
}

/// Numbers that share a size: the components of a vector or matrix.
std::string family(const std::string& name) {
  static const std::regex component("(_|^(sin|cos)_)(t?)[xyz]{1,2}(_|$)");
  return std::regex_replace(name, component, "_$3*_");
}

double scale_of(const std::string& name, const Json& parameters) {
  if (name == "phase_rad" || name == "rest_rad") return 1.0;  // rad: their zero is arbitrary
  double scale = 0.0;
  for (const auto& [other, value] : parameters.items()) {
    if (family(other) == family(name)) scale = std::max(scale, std::abs(value.get<double>()));
  }
  return scale;
}

/// The name of a number in a finding: on an axis of a machine its unit is left out.
std::string said_name(const std::string& name, const Json& parameters) {
  if (parameters.contains(name)) return name;
  for (const auto& [stem, value] : parameters.items()) {
    if (name.rfind(stem + "_", 0) == 0) return stem;
  }
  return "";
}

Json score_parameters(const Json& hidden, const Json& finding) {
  Json all = Json::object();
  for (const auto& [name, value] : hidden["parameters"].items()) {
    const Json& parameters = finding["parameters"];
    const std::string stem = said_name(name, parameters);
    if (stem.empty()) continue;
    double shift = 0.0;
    const double truth = value, said = parameters[stem]["value"];
    if (name == "phase_rad") {
      constexpr double kTurn = 2.0 * std::numbers::pi;
      shift = kTurn * std::round((said - truth) / kTurn);
    }
    const Json& interval = parameters[stem]["ci95"];
    all[name] = {{"truth", truth},
                 {"said", said},
                 {"error", std::abs(said - shift - truth) / scale_of(name, hidden["parameters"])},
                 {"covered", nullptr}};
    if (interval.is_array()) {
      const double low = interval[0], high = interval[1];
      all[name]["covered"] = low - shift <= truth && truth <= high - shift;
    }
  }
  return all;
}

Json overlap(const Json& a, const Json& b) {
  if (!a.is_array()) return nullptr;
  if (!b.is_array()) return 0.0;
  const double from = a[0], to = a[1], other_from = b[0], other_to = b[1];
  const double both = std::min(to, other_to) - std::max(from, other_from);
  return std::max(0.0, both) / (std::max(to, other_to) - std::min(from, other_from));
}

/// Along the tool is the sensor's z axis.
std::string axis_name(const Json& axis) {
  const std::string name = axis.is_string() ? axis.get<std::string>() : "";
  return name == "tool_z" ? "sensor_z" : name;
}

Json score_effect(const Json& hidden, const Json* finding) {
  Json one{{"effect", hidden["effect"]},
           {"amplitude", hidden["amplitude"]},
           {"listed", hidden["listed"]},
           {"named", finding != nullptr && is_name_of(hidden, *finding)},
           {"in_class", finding != nullptr},
           {"axis_right", nullptr},
           {"interval_overlap", nullptr},
           {"parameters", Json::object()}};
  if (!one["named"].get<bool>()) return one;
  if (!hidden["axis"].is_null()) {
    one["axis_right"] = axis_name(hidden["axis"]) == axis_name((*finding)["axis"]);
  }
  one["interval_overlap"] = overlap(hidden["interval_s"], (*finding)["interval_s"]);
  const bool same_law = (*finding)["effect"] == hidden["effect"] && !hidden["foreign"].get<bool>();
  if (same_law) one["parameters"] = score_parameters(hidden, *finding);
  return one;
}

std::string right_verdicts(const std::string& group) {
  if (has("null faint", group)) return "consistent";
  if (group == "foreign") return "explained partly-explained";
  if (has("unlisted law", group)) return "unexplained";
  if (group == "weak") return "explained consistent";
  return group == "mixed" ? "partly-explained" : "explained";
}

/// Findings but for those that say what the log itself does (`optional`): a delay where its
/// velocity is filtered, rounding where its readings are. They are true, and not asked for.
Json judged(const Json& answer, const Json& findings) {
  const Json optional = answer.value("optional", Json::array());
  Json kept = Json::array();
  for (const Json& f : findings) {
    if (!holds(optional, f["effect"])) kept.push_back(f);
  }
  return kept;
}

/// Of a law without a name hidden in an axis: that something unnamed remains is right, and so is a
/// discovered law that predicts what was held out as the true one does.
bool unnamed_is_told(const Json& scored) {
  if (has("unexplained partly-explained", scored["verdict"])) return true;
  const Json& h = scored["holdout"];
  return !scored["laws"].empty() && h.contains("after") && h.contains("oracle") &&
         h["after"].get<double>() <= kWithin * h["oracle"].get<double>();
}

/// {said, right} of each name of the catalogue that has a probability: right where it is hidden.
Json told_confidences(const Json& hidden, const Json& findings) {
  Json all = Json::array();
  for (const Json& f : findings) {
    const Json said = f.value("confidence", Json());
    if (!said.is_number() || has("unnamed discovered", f["effect"].get<std::string>())) continue;
    all.push_back({{"said", said}, {"right", is_hidden(hidden, f)}});
  }
  return all;
}

/// Whether a finding is a law of the same kind as the effect: another friction for a friction.
bool kind_is_named(const Json& hidden, const Json& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [&](const Json& f) { return axis_class(f["effect"]) == hidden["class"]; });
}

/// Mean over channels, each in its own unit.
double mean(const Json& list, const std::vector<double>& unit) {
  double sum = 0.0;
  for (std::size_t k = 0; k < list.size(); ++k) sum += list[k].get<double>() / unit.at(k);
  return sum / static_cast<double>(list.size());
}

Json score_holdout(const Json& answer, const Json& report) {
  Json out = Json::object();
  const Json& oracle = answer["oracle_rmse"];
  // Forces in N; beside torques, and of joints, each channel by what the true law leaves.
  std::vector<double> unit(3, 1.0);
  if (oracle.is_array() && oracle.size() > unit.size()) unit = oracle.get<std::vector<double>>();
  const Json fit = report.is_object() ? report.value("fit", Json::object()) : Json::object();
  for (const auto& [key, name] : {std::pair{"holdout_rmse_before", "before"},
                                  {"holdout_rmse_after", "after"},
                                  {"noise_floor", "floor"}}) {
    if (fit.contains(key) && fit[key].is_array()) out[name] = mean(fit[key], unit);
  }
  if (oracle.is_array()) out["oracle"] = mean(oracle, unit);
  return out;
}

}  // namespace

Json score(const Json& answer, const Json& report) {
  const Json none = Json::array();
  const Json& hidden = answer["hidden"];
  const Json& all = report.is_object() && report.contains("findings") ? report["findings"] : none;
  const Json findings = judged(answer, all);
  Json one{{"id", answer["id"]},
           {"drawn", answer["drawn"]},
           {"group", answer["group"]},
           {"family", answer.value("family", "plain")},
           {"motion", answer["motion"]},
           {"noise", answer["noise"]},
           {"hidden", none},
           {"named", none},
           {"laws", none},
           {"effects", none}};
  one["verdict"] = report.is_object() ? report["verdict"] : Json("failed");
  const std::vector<const Json*> match = matched(hidden, findings);
  std::size_t in_class = 0, by_name = 0, wanted = 0, listed_names = 0;
  for (std::size_t h = 0; h < hidden.size(); ++h) {
    one["hidden"].push_back(hidden[h]["effect"]);
    one["effects"].push_back(score_effect(hidden[h], match[h]));
    if (hidden[h].contains("class")) {
      one["effects"].back()["kind_named"] = kind_is_named(hidden[h], findings);
    }
    wanted += hidden[h]["listed"].get<bool>() ? 1 : 0;
    in_class += match[h] != nullptr ? 1 : 0;
    by_name += one["effects"].back()["named"].get<bool>() ? 1 : 0;
  }
  for (const Json& f : findings) {
    one["named"].push_back(f["effect"]);
    listed_names += !has("unnamed discovered", f["effect"].get<std::string>());
    if (f.contains("law")) one["laws"].push_back(f["law"]);
  }
  one["false_names"] = listed_names - in_class;
  one["top1"] = !findings.empty() && is_hidden(hidden, findings[0]);
  one["set"] = by_name == wanted && listed_names == wanted && report.is_object();
  one["class_set"] = in_class == wanted && listed_names == wanted && report.is_object();
  const std::string right = right_verdicts(answer["group"]);
  const bool of_log_alone = findings.empty() && !all.empty() && one["verdict"] == "explained";
  one["verdict_right"] = has(right, one["verdict"]) || (of_log_alone && has(right, "consistent"));
  one["holdout"] = score_holdout(answer, report);
  one["confidences"] = told_confidences(hidden, findings);
  if (one["family"] == "axis" && has("unlisted mixed", answer["group"])) {
    one["verdict_right"] = unnamed_is_told(one);
  }
  return one;
}

}  // namespace dcnn::conceal
