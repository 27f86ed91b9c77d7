// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <set>

#include "conceal/draws.h"
#include "conceal/tally.h"
#include "core/elementary.h"
#include "dcnn/conceal/challenge.h"
#include "dcnn/core/excerpt.h"
#include "dcnn/core/file.h"

namespace dcnn::conceal {
namespace {

namespace fs = std::filesystem;

Json read_if_there(const fs::path& file) {
  return fs::exists(file) ? read_json(file, Exit::kData) : Json();
}

/// The nominal amplitude nearest in the logarithm; effects whose size is the motion's as well.
std::string amplitude_class(double amplitude) {
  static const std::vector<std::pair<double, std::string>> nominal{
      {0.05, "0.05"}, {0.1, "0.1"}, {0.2, "0.2"}, {0.3, "0.3"}, {0.5, "0.5"},
      {1.0, "1"},     {2.0, "2"},   {5.0, "5"},   {15.0, "15"}};
  std::string best;
  double least = 1e9;
  for (const auto& [value, name] : nominal) {
    const double distance = std::abs(elementary::log(amplitude / value));
    if (distance < least) least = distance, best = name;
  }
  return best;
}

Json rows(const std::map<std::string, Tally>& tallies) {
  Json out = Json::object();
  for (const auto& [label, tally] : tallies) out[label] = tally.summary();
  return out;
}

/// The amplitude for which a scenario was drawn: group:amplitude/effect/number.
std::string drawn_amplitude(const Json& scenario) {
  const std::string id = scenario["drawn"];
  const auto colon = id.find(':');
  const std::string text = id.substr(colon + 1, id.find('/') - colon - 1);
  double amplitude = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), amplitude);
  if (error != std::errc() || rest != text.data() + text.size()) {
    throw Json::exception("'drawn' names no amplitude: " + excerpt(id));
  }
  return text;
}

/// How often each effect alone was named, or was among the alternatives, by drawn amplitude.
Json single_effects(const Json& scenarios) {
  Json table = Json::object();
  for (const Json& s : scenarios) {
    if (s["group"] != "single") continue;
    const Json& e = s["effects"][0];
    Json& cell = table[e["effect"].get<std::string>()][drawn_amplitude(s)];
    if (cell.is_null()) cell = Json::object();
    const auto count = [&](const char* key, bool counts) {
      cell[key] = cell.value(key, 0) + (counts ? 1 : 0);
    };
    count("of", true);
    count("named", e["named"].get<bool>());
    count("in_class", e["in_class"].get<bool>());
  }
  return table;
}

Json tabulate(const Json& scenarios) {
  Tally all;
  std::map<std::string, Tally> group, family, effect, amplitude, motion, noise, single;
  for (const Json& s : scenarios) {
    add_scenario(s, all);
    if (s["group"] == "single") add_scenario(s, single["single, " + drawn_amplitude(s)]);
    add_scenario(s, group[s["group"]]);
    add_scenario(s, family[s.value("family", "plain")]);
    add_scenario(s, motion[s["motion"]]);
    add_scenario(s, noise[s["noise"]["kind"]]);
    if (s["group"] == "faint") continue;
    if (s["effects"].size() == 1) add_holdout(s, effect[s["effects"][0]["effect"]]);
    for (const Json& e : s["effects"]) {
      add_effect(e, effect[e["effect"]]);
      add_effect(e, amplitude[amplitude_class(e["amplitude"])]);
    }
  }
  std::erase_if(effect, [](const auto& row) { return row.second.summary().empty(); });
  return {{"all", all.summary()},
          {"group", rows(group)},
          {"family", rows(family)},
          {"effect", rows(effect)},
          {"amplitude", rows(amplitude)},
          {"motion", rows(motion)},
          {"noise", rows(noise)},
          {"single", rows(single)},
          {"single_effect", single_effects(scenarios)},
          {"confidence", confidence_table(scenarios)}};
}

/// Every answer against FOLDER/<id>/<below>/report.json; those that are not there yet are missing.
Json score_reports(const Json& answers, const fs::path& folder, const fs::path& below) {
  Json out{{"missing", Json::array()}, {"scenarios", Json::array()}};
  for (const Json& answer : answers["scenarios"]) {
    const fs::path reports = folder / answer["id"].get<std::string>();
    const Json run = read_if_there(reports / "run.json");
    const Json report = read_if_there(reports / below / "report.json");
    if (run.is_null() && report.is_null()) {
      out["missing"].push_back(answer["id"]);
      continue;
    }
    Json one = score(answer, report);
    one["seconds"] = run.is_object() ? run.value("seconds", Json()) : Json();
    if (report.is_object()) {
      one["seconds"] = report.value("seconds", one["seconds"]);  // several methods in one run
      one["fit_only"] = report.value("fit_only", false);
    }
    one["exit"] = run.is_object() ? run.value("exit", Json()) : Json();
    out["scenarios"].push_back(one);
  }
  out["tables"] = tabulate(out["scenarios"]);
  return out;
}

/// Names of the folders below a folder, in order.
std::set<std::string> folders_in(const fs::path& folder) {
  std::set<std::string> names;
  if (!fs::exists(folder)) return names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory() && name.front() != '.') names.insert(name);
  }
  return names;
}

/// Methods with a report in any scenario.
std::set<std::string> methods_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const std::string& scenario : folders_in(folder)) names.merge(folders_in(folder / scenario));
  return names;
}

Json rates_of(const Json& answers, const fs::path& folder, const fs::path& below) {
  return score_reports(answers, folder, below)["tables"]["all"];
}

Json scores_of(const fs::path& folder, const fs::path& seal) {
  const Json answers = open_seal(folder, seal);
  const std::string digest = read_file(folder / "seal.sha256", 4096, Exit::kData).substr(0, 64);
  Json out{{"seed", answers["seed"]}, {"sha256", digest}};
  out.update(score_reports(answers, folder / "reports", ""));
  out["rivals"] = Json::object();
  out["ablations"] = Json::object();
  for (const std::string& method : methods_in(folder / "rivals")) {
    out["rivals"][method] = rates_of(answers, folder / "rivals", method);
  }
  for (const std::string& part : folders_in(folder / "ablations")) {
    out["ablations"][part] = rates_of(answers, folder / "ablations" / part, "");
  }
  return out;
}

}  // namespace

Json score_challenge(const fs::path& folder, const fs::path& seal) {
  try {
    return scores_of(folder, seal);
  } catch (const Json::exception& error) {
    fail(Exit::kData, seal.string(), ": it, or a report below ", folder.string(),
         ", is not of dcnn-conceal and dcnn-diagnose: ", error.what());
  }
}

}  // namespace dcnn::conceal
