// SPDX-License-Identifier: Apache-2.0
#include "experiment/finding_words.h"

#include <algorithm>

#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/effect_words.h"
#include "experiment/markup.h"
#include "experiment/report_words.h"

namespace dcnn {

std::string plain_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.is_null() ? "" : value.dump();
}

std::string place_in_words(const Json& finding) {
  std::string text = words_of_axis(plain_text(finding["axis"]));
  const Json interval = finding.value("interval_s", Json());
  if (interval.is_null()) return text;
  text += (text.empty() ? "from " : ", from ") + fixed(interval[0].get<double>(), 1) + " to " +
          fixed(interval[1].get<double>(), 1) + " s";
  return finding.contains("recording") ? text + " of " + plain_text(finding["recording"]) : text;
}

std::vector<std::string> numbers_in_words(const Json& finding) {
  std::vector<std::string> words;
  const std::string effect = plain_text(finding["effect"]);
  int of_tables = 0;
  for (const auto& [name, number] : finding["parameters"].items()) {
    if (effect == "discovered" && name.starts_with("value_")) {  // its picture tells more
      ++of_tables;
      continue;
    }
    if (number["value"].is_string()) {
      words.push_back(words_of_parameter(effect, name) + ": " + plain_text(number["value"]));
      continue;
    }
    const auto value = number["value"].get<double>();
    const Json& interval = number["ci95"];
    // Held at nothing, as a spring's rest is beside a constant: no number of its own.
    if (value == 0.0 && interval[0] == 0.0 && interval[1] == 0.0) continue;
    const std::string unit = unit_in_words(effect, name, plain_text(number["unit"]));
    if (!is_told(number)) {
      words.push_back(words_of_parameter(effect, name) + ": not told, " +
                      with_unit(interval[0].get<double>(), unit) + " to " +
                      with_unit(interval[1].get<double>(), unit));
      continue;
    }
    words.push_back(
        words_of_parameter(effect, name) + ": " +
        (interval[0].is_null() || interval[1].is_null()
             ? with_unit(value, unit)
             : with_interval(value, interval[0].get<double>(), interval[1].get<double>(), unit)));
  }
  if (of_tables > 0) {
    words.push_back(std::to_string(of_tables) + " values of a curve, listed in report.json");
  }
  return words;
}

std::vector<std::string> alternatives_in_words(const Json& finding) {
  std::vector<std::string> words;
  const Json shared = finding.value("shared_with", Json::object());
  for (const Json& other : finding["alternatives"]) {
    const std::string id = plain_text(other.is_object() ? other["effect"] : other);
    const bool share = shared.contains(id) && !shared[id].is_null();
    words.push_back(words_of_effect(id, plain_text(finding["axis"])) +
                    (share ? " (" + percent(shared[id].get<double>()) + ")" : ""));
  }
  return words;
}

bool remains_untried(const Json& report) {
  if (!report.contains("search") || report["search"]["complete"].get<bool>()) return false;
  const auto verdict = report["verdict"].get<std::string>();
  return verdict != "explained" && verdict != "consistent";
}

std::string verdict_in_words(std::string verdict) {
  std::replace(verdict.begin(), verdict.end(), '-', ' ');
  return verdict;
}

std::string question_in_words(const Json& next_motion) {
  const std::string one = plain_text(next_motion["separates"][0]),
                    other = plain_text(next_motion["separates"][1]);
  if (other == "unknown") return "to see what no name describes";
  return "to tell " + words_of_structure(one) + " from " + words_of_structure(other);
}

}  // namespace dcnn
