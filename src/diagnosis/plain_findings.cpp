// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/plain_findings.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "dcnn/core/number.h"
#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/effect.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/words.h"

namespace dcnn {
namespace {

/// The parameter of this stem: "fc" of an axis, "fc_n" of a tool; null where there is none.
Json numbers_of(const Json& finding, const std::string& stem) {
  for (const auto& [name, number] : finding["parameters"].items()) {
    if (name == stem || name.starts_with(stem + "_")) return number;
  }
  return nullptr;
}

double said_value(const Json& finding, const std::string& stem) {
  const Json number = numbers_of(finding, stem);
  return number.is_null() ? 0.0 : number["value"].get<double>();
}

std::string unit_of(const Json& finding, const std::string& stem) {
  const Json number = numbers_of(finding, stem);
  return number.is_null() ? "" : unit_text(number["unit"].get<std::string>());
}

bool is_friction(const Json& finding) {
  const EffectKind* kind = find_effect(finding["effect"]);
  return kind && kind->friction != EffectKind::Friction::kNone && !finding.contains("driven_over");
}

bool same_axis(const Json& a, const Json& b) { return a["axis"] == b["axis"]; }

/// The finding of this effect, or null.
Json of_effect(const Json& findings, const char* effect) {
  for (const Json& f : findings) {
    if (f["effect"] == effect) return f;
  }
  return nullptr;
}

/// All that resists at any speed, at rest as well where that is more.
std::string dry_part(const Json& findings) {
  double sum = 0.0, more = 0.0;
  std::string unit;
  for (const Json& f : findings) {
    const Json number = numbers_of(f, "fc");
    if (number.is_null()) continue;
    sum += number["value"].get<double>();
    unit = unit_of(f, "fc");
    const Json at_rest = numbers_of(f, "fs");
    if (!at_rest.is_null()) more += at_rest["value"].get<double>() - said_value(f, "fc");
  }
  if (unit.empty()) return "";
  std::string text = brief(sum) + " " + unit + " dry";
  if (more > 0.0) text += " (" + brief(sum + more) + " " + unit + " at rest)";
  if (const Json gear = of_effect(findings, "gear_friction"); !gear.is_null()) {
    text += ", varying by " + brief(100.0 * said_value(gear, "a") * said_value(gear, "fc") / sum) +
            " % with order " + brief(said_value(gear, "order")) + " of the position";
  }
  return text;
}

std::string viscous_part(const Json& findings) {
  const Json even = of_effect(findings, "viscous_friction");
  const Json uneven = of_effect(findings, "asymmetric_friction");
  if (even.is_null() && uneven.is_null()) return "";
  const double d = uneven.is_null() ? 0.0 : said_value(uneven, "delta_c");
  if (even.is_null()) {
    return brief(std::abs(d)) + " " + unit_of(uneven, "delta_c") + " of difference each way";
  }
  const double c = said_value(even, "c");
  const std::string unit = unit_of(even, "c");
  std::string slower;
  if (!numbers_of(even, "v1").is_null()) {
    slower = " at low speed, half of that from " + brief(said_value(even, "v1")) + " " +
             unit_of(even, "v1") + " on";
  }
  if (uneven.is_null()) return brief(c) + " " + unit + " viscous" + slower;
  return brief(c + d) + " " + unit + " viscous forwards and " + brief(c - d) + " backwards" +
         slower;
}

/// The way in which bristles give way: fc/sigma0, in thousandths; nothing where it is not told.
std::string presliding_part(const Json& findings) {
  const Json lugre = of_effect(findings, "lugre_friction");
  if (lugre.is_null() || said_value(lugre, "sigma0") <= 0.0) return "";
  if (!is_told(numbers_of(lugre, "sigma0"))) return "";
  const std::string unit = unit_of(lugre, "sigma0");
  const std::string length = unit.substr(unit.rfind('/') + 1);
  const double way = said_value(lugre, "fc") / said_value(lugre, "sigma0");
  const bool si = length == "m" || length == "rad";
  return (si ? brief(1e3 * way) + " m" : brief(way) + " ") + length + " of presliding";
}

/// What stands behind the law in the words of a single finding: " along the tool".
std::string place_of(const Json& finding) {
  const std::string words = finding["words"];
  for (const char* begin : {" along the ", " against turning ", " on "}) {
    const auto at = words.find(begin);
    if (at != std::string::npos) return words.substr(at);
  }
  return "";
}

/// Below all numbers where there is none.
double number_or_least(const Json& finding, const char* key) {
  const Json value = finding.value(key, Json());
  return value.is_null() ? -1e300 : value.get<double>();
}

/// Several findings as one, their numbers side by side.
Json merged_friction(const Json& group) {
  Json one = group.front();
  one["effect"] = "friction";
  one["words"] = friction_words(group) + place_of(group.front());
  one["parameters"] = Json::object();
  std::set<std::string> alternatives;
  for (const Json& f : group) {
    for (const auto& [name, number] : f["parameters"].items()) {
      const bool taken = one["parameters"].contains(name);
      one["parameters"][taken ? f["effect"].get<std::string>() + "." + name : name] = number;
    }
    // That there is friction is as probable as the most probable of its forms.
    if (number_or_least(f, "confidence") > number_or_least(one, "confidence")) {
      one["confidence"] = f["confidence"];
      one["shared_with"] = f.value("shared_with", Json::object());
    }
    if (number_or_least(f, "holdout_gain") < number_or_least(one, "holdout_gain")) {
      one["holdout_gain"] = f.value("holdout_gain", Json());
    }
    for (const Json& a : f["alternatives"]) {
      const Json& id = a.is_object() ? a["effect"] : a;
      if (of_effect(group, id.get<std::string>().c_str()).is_null()) {
        alternatives.insert(id.get<std::string>());
      }
    }
  }
  one["alternatives"] = Json::array();
  for (const auto& id : alternatives) one["alternatives"].push_back(id);
  return one;
}

/// A spring that is a constant, with the one number that means something.
Json as_constant(Json finding) {
  const double size = std::abs(said_value(finding, "k") * said_value(finding, "rest"));
  const std::string unit = numbers_of(finding, "k")["unit"];
  finding["effect"] = "constant_force";
  finding["parameters"] = {
      {"force",
       {{"value", size}, {"ci95", {nullptr, nullptr}}, {"unit", unit.substr(0, unit.rfind('/'))}}}};
  return finding;
}

}  // namespace

bool is_doubtful(const Json& finding) {
  const Json own = finding.value("confidence", Json());
  if (own.is_null()) return false;
  double probability = own;
  const Json shared = finding.value("shared_with", Json::object());  // lives through the loop
  for (const auto& [name, share] : shared.items()) {
    probability += share.get<double>();
  }
  return probability < 0.5;
}

bool is_constant(const Json& finding) {
  const EffectKind* kind = find_effect(finding["effect"]);
  if (!kind || kind->course != EffectKind::Course::kStraight) return false;
  if (finding.contains("driven_over")) return false;
  const Json k = numbers_of(finding, "k"), rest = numbers_of(finding, "rest");
  if (k.is_null() || rest.is_null()) return false;
  if (k["ci95"][0].get<double>() <= 0.0 && k["ci95"][1].get<double>() >= 0.0) return true;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return rest["unit"] == "rad" &&
         std::abs(rest["value"].get<double>()) > prior::kMostTurnsAway * kTurn;
}

std::string constant_words(const Json& finding) {
  const std::string unit = numbers_of(finding, "k")["unit"];
  const std::string axis = finding["axis"].is_string() ? finding["axis"].get<std::string>() : "";
  std::string text = "a constant of " +
                     brief(std::abs(said_value(finding, "k") * said_value(finding, "rest"))) + " " +
                     unit_text(unit.substr(0, unit.rfind('/')));
  const auto colon = axis.find(':');
  if (colon == std::string::npos) return text;
  const std::string line = axis.substr(colon + 1);
  if (line.starts_with("base_")) {
    return text + " along the base's " + line.substr(5) + " axis, as " +
           (line == "base_z" ? "a weight" : "a tilt of gravity") + " makes";
  }
  return text + " along the " +
         (line == "tool_z" ? "tool" : "sensor's " + line.substr(7) + " axis") +
         ", as an offset of the sensor makes";
}

std::string friction_words(const Json& findings) {
  std::string text;
  const auto add = [&](const std::string& part) {
    if (!part.empty()) text += (text.empty() ? "friction: " : ", ") + part;
  };
  add(dry_part(findings));
  add(viscous_part(findings));
  if (const Json drag = of_effect(findings, "quadratic_drag"); !drag.is_null()) {
    add(brief(said_value(drag, "c2")) + " " + unit_of(drag, "c2") + " of drag");
  }
  if (const Json load = of_effect(findings, "load_friction"); !load.is_null()) {
    add(brief(100.0 * said_value(load, "mu")) + " % of the load");
  }
  add(presliding_part(findings));
  return text;
}

bool is_told(const Json& number) {
  const Json& ends = number["ci95"];
  if (!ends.is_array() || ends[0].is_null() || ends[1].is_null()) return true;
  const double low = ends[0], high = ends[1];
  return low <= 0.0 || high <= prior::kKnownWithin * prior::kKnownWithin * low;
}

Json in_lines(const Json& findings) {
  Json lines = Json::array();
  std::vector<bool> told(findings.size(), false);
  for (std::size_t k = 0; k < findings.size(); ++k) {
    if (told[k]) continue;
    Json group = Json::array({findings[k]});
    for (std::size_t j = k + 1; j < findings.size() && is_friction(findings[k]); ++j) {
      if (!is_friction(findings[j]) || !same_axis(findings[k], findings[j])) continue;
      group.push_back(findings[j]);
      told[j] = true;
    }
    if (group.size() > 1) {
      lines.push_back(merged_friction(group));
    } else {
      lines.push_back(is_constant(findings[k]) ? as_constant(findings[k]) : findings[k]);
    }
  }
  return lines;
}

}  // namespace dcnn
