#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>

#include "conceal/draws.h"
#include "dcnn/conceal/challenge.h"

namespace dcnn::conceal {
namespace {

bool holds(const Json& list, const std::string& id) {
  return std::find(list.begin(), list.end(), id) != list.end();
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
        const bool fits = by == By::kAlternative ? holds(f["alternatives"], id) : f["effect"] == id;
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
           {"named", finding != nullptr && (*finding)["effect"] == hidden["effect"]},
           {"in_class", finding != nullptr},
           {"axis_right", nullptr},
           {"interval_overlap", nullptr},
           {"parameters", Json::object()}};
  if (!one["named"].get<bool>()) return one;
  if (!hidden["axis"].is_null()) {
    one["axis_right"] = axis_name(hidden["axis"]) == axis_name((*finding)["axis"]);
  }
  one["interval_overlap"] = overlap(hidden["interval_s"], (*finding)["interval_s"]);
  if (!hidden["foreign"].get<bool>()) one["parameters"] = score_parameters(hidden, *finding);
  return one;
}

std::string right_verdicts(const std::string& group) {
  if (has("null faint", group)) return "consistent";
  if (group == "foreign") return "explained partly-explained";
  if (has("unlisted law", group)) return "unexplained";
  return group == "mixed" ? "partly-explained" : "explained";
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
  const Json& findings =
      report.is_object() && report.contains("findings") ? report["findings"] : none;
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
  one["top1"] = !findings.empty() && holds(one["hidden"], findings[0]["effect"]);
  one["set"] = by_name == wanted && listed_names == wanted && report.is_object();
  one["class_set"] = in_class == wanted && listed_names == wanted && report.is_object();
  one["verdict_right"] = has(right_verdicts(answer["group"]), one["verdict"]);
  one["holdout"] = score_holdout(answer, report);
  return one;
}

}  // namespace dcnn::conceal
