// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>

#include "core/lists.h"
#include "dcnn/core/number.h"
#include "dcnn/identification/identify.h"

namespace dcnn {
namespace {

Json estimates_json(const std::vector<IdentifiedNumber>& estimates) {
  Json all = Json::object();
  for (const IdentifiedNumber& e : estimates) {
    Json one{{"value", e.value}, {"unit", e.unit}, {"shown", e.shown}};
    one["ci95"] = Json::array({e.low, e.high});
    one["motion"] = e.motion.empty() ? Json() : Json(e.motion);
    all[e.name] = one;
  }
  return all;
}

/// "centre of mass, x" for "com_x_m".
std::string words_of_number(const std::string& name) {
  static constexpr std::pair<const char*, const char*> kWords[]{
      {"com", "centre of mass"}, {"bias_t", "torque offset, "}, {"bias", "force offset"}};
  std::string words = name.substr(0, name.rfind('_'));  // without the unit
  for (const auto& [stem, meaning] : kWords) {
    if (words.starts_with(stem)) {
      words = meaning + words.substr(std::string(stem).size());
      break;
    }
  }
  const auto axis = words.rfind('_');
  return axis == words.npos ? words : words.replace(axis, 1, ", ");
}

std::string line_of(const IdentifiedNumber& e) {
  char line[200];
  const double half = 0.5 * (e.high - e.low);
  // As many decimals as the interval has two digits for.
  const int decimals = half > 0.0 && std::isfinite(half)
                           ? std::clamp(1 - static_cast<int>(std::floor(std::log10(half))), 0, 9)
                           : 6;
  std::snprintf(line, sizeof line, "  %-20s %*.*f  [%.*f, %.*f] %s%s\n",
                words_of_number(e.name).c_str(), 11, decimals, e.value, decimals, e.low, decimals,
                e.high, unit_text(e.unit).c_str(), e.shown ? "" : "   not shown");
  return line;
}

/// One line for each motion: which numbers it would show.
std::string missing_text(const std::vector<IdentifiedNumber>& estimates) {
  std::vector<std::pair<std::string, std::vector<std::string>>> motions;
  for (const IdentifiedNumber& e : estimates) {
    if (e.shown) continue;
    auto found = std::find_if(motions.begin(), motions.end(),
                              [&](const auto& m) { return m.first == e.motion; });
    if (found == motions.end()) found = motions.insert(motions.end(), {e.motion, {}});
    found->second.push_back(words_of_number(e.name));
  }
  std::string text;
  for (const auto& [motion, names] : motions) {
    text += "  " + joined(names) + ": " + motion + "\n";
  }
  return text;
}

}  // namespace

Json to_json(const ToolIdentification& id) {
  Json json{{"recordings", id.recordings},
            {"simulator", to_json(id.model)},
            {"parameters", estimates_json(id.parameters)},
            {"targets", id.targets},
            {"units", id.units},
            {"residual_rms", json_list(id.residual_rms)},
            {"measured_rms", json_list(id.measured_rms)},
            {"cutoff_hz", json_list(id.cutoff_hz)},
            {"constrained", id.constrained},
            {"possible_share", id.possible_share},
            {"notes", id.notes}};
  Json beside = Json::array();
  for (const BesideTool& law : id.beside) {
    Json one{{"effect", law.effect}, {"words", law.words}};
    one["axis"] = law.axis.empty() ? Json() : Json(law.axis);
    one["parameters"] = estimates_json(law.parameters);
    beside.push_back(one);
  }
  json["beside"] = beside;
  Json missing = Json::array();
  for (const IdentifiedNumber& e : id.parameters) {
    if (!e.shown) missing.push_back(Json{{"parameter", e.name}, {"motion", e.motion}});
  }
  json["not_shown"] = missing;
  return json;
}

std::string to_text(const ToolIdentification& id) {
  std::string text =
      "The tool in the sensor's frame, from " + joined(id.recordings) + " (95 % intervals):\n";
  for (const IdentifiedNumber& e : id.parameters) text += line_of(e);
  char line[160];
  const auto rms = [](const auto& channels) { return channels.norm() / std::sqrt(3.0); };
  std::snprintf(line, sizeof line, "Residual: %.3g N of %.3g N", rms(id.residual_rms.head(3)),
                rms(id.measured_rms.head(3)));
  text += line;
  if (id.residual_rms.size() == 6) {
    std::snprintf(line, sizeof line, ", %.3g N·m of %.3g N·m", rms(id.residual_rms.tail(3)),
                  rms(id.measured_rms.tail(3)));
    text += line;
  }
  text += " rms in the motion's band.\n";
  if (id.constrained) {
    text +=
        "Least squares alone gave a body that cannot exist; the numbers are those of bodies that "
        "can.\n";
  }
  if (!id.beside.empty()) text += "Fitted beside the tool, since the data show it:\n";
  for (const BesideTool& law : id.beside) text += "  " + law.words + "\n";
  const std::string missing = missing_text(id.parameters);
  if (!missing.empty()) {
    text += "Not shown by this motion, and what would show it:\n" + missing;
  }
  return text;
}

}  // namespace dcnn
