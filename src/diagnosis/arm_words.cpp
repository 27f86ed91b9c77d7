// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/arm_words.h"

#include <algorithm>
#include <map>

#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/effect_words.h"
#include "diagnosis/plain_findings.h"

namespace dcnn {
namespace {

/// "dry and viscous friction": nouns in a row, an ending that neighbours share said once.
std::string in_a_row(const std::vector<std::string>& nouns) {
  const std::string shared = " friction";
  std::string text;
  for (std::size_t k = 0; k < nouns.size(); ++k) {
    if (k > 0) text += k + 1 == nouns.size() ? " and " : ", ";
    const bool again =
        k + 1 < nouns.size() && nouns[k].ends_with(shared) && nouns[k + 1].ends_with(shared);
    text += again ? nouns[k].substr(0, nouns[k].size() - shared.size()) : nouns[k];
  }
  return text;
}

/// "joint1 to joint4 and joint6".
std::string listed(const std::vector<std::size_t>& joints, const System& system) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < joints.size();) {
    std::size_t last = k;
    while (last + 1 < joints.size() && joints[last + 1] == joints[last] + 1) ++last;
    const std::string from = system.axes[joints[k]].name, to = system.axes[joints[last]].name;
    if (last > k + 1) {
      parts.push_back(from + " to " + to);
    } else {
      parts.push_back(from);
      if (last > k) parts.push_back(to);
    }
    k = last + 1;
  }
  return in_a_row(parts);
}

/// The effect by which a finding is called: bristles whose stiffness is not told are dry friction.
std::string called(const Json& finding) {
  std::string effect = finding["effect"];
  const Json numbers = finding.value("parameters", Json::object());
  const bool dry =
      effect == "lugre_friction" && numbers.contains("sigma0") && !is_told(numbers["sigma0"]);
  return dry ? "coulomb_friction" : effect;
}

std::size_t joint_of(const Json& name, const System& system) {
  for (std::size_t k = 0; k < system.axes.size(); ++k) {
    if (name == system.axes[k].name) return k;
  }
  return system.axes.size();
}

}  // namespace

Json joints_json(const std::vector<Json>& reports, const System& system) {
  Json joints = Json::array();
  for (std::size_t k = 0; k < reports.size(); ++k) {
    std::string words;
    for (const Json& line : in_lines(reports[k]["findings"])) {
      words += (words.empty() ? "" : "; ") + line["words"].get<std::string>() +
               (is_doubtful(line) ? " (not established)" : "");
    }
    const Json& unnamed = reports[k]["unnamed"]["words"];
    if (!unnamed.is_null()) words += (words.empty() ? "" : "; and ") + unnamed.get<std::string>();
    joints.push_back({{"axis", system.axes[k].name},
                      {"verdict", reports[k]["verdict"]},
                      {"words", words.empty() ? "nothing is missing" : words}});
  }
  return joints;
}

Json arm_json(const Json& report, const System& system) {
  std::string words;
  const auto add = [&](const std::string& part) { words += (words.empty() ? "" : "; ") + part; };
  std::vector<std::string> effects;  // in the order in which they are met
  std::map<std::string, std::vector<std::size_t>> joints;
  for (const Json& finding : report["findings"]) {
    if (is_doubtful(finding)) continue;
    const std::string effect = called(finding);
    const std::size_t joint = joint_of(finding["axis"], system);
    if (joint == system.axes.size()) {
      add(finding["words"].get<std::string>());
      continue;
    }
    std::vector<std::size_t>& list = joints[effect];
    if (list.empty()) effects.push_back(effect);
    if (list.empty() || list.back() != joint) list.push_back(joint);
  }
  std::vector<std::vector<std::size_t>> told;
  for (const std::string& effect : effects) {
    const std::vector<std::size_t>& where = joints[effect];
    if (std::find(told.begin(), told.end(), where) != told.end()) continue;
    told.push_back(where);
    std::vector<std::string> nouns;
    for (const std::string& other : effects) {
      if (joints[other] == where)
        nouns.push_back(words_of_effect(other, system.axes[where.front()].name));
    }
    add(in_a_row(nouns) + " on " + listed(where, system));
  }
  std::vector<std::size_t> unnamed;
  for (const Json& joint : report["joints"]) {
    if (joint["verdict"] == "unexplained" || joint["verdict"] == "partly-explained") {
      unnamed.push_back(joint_of(joint["axis"], system));
    }
  }
  const bool named = !words.empty();
  if (!unnamed.empty()) {
    add("something without a name on " + listed(unnamed, system));
  } else {
    add(named ? "nothing else" : "nothing is missing");
  }
  return {{"verdict", report["verdict"]}, {"words", words}};
}

}  // namespace dcnn
