// SPDX-License-Identifier: Apache-2.0
#include "experiment/diagnosis_tables.h"

#include <algorithm>
#include <set>

#include "dcnn/core/number.h"
#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/effect_words.h"
#include "experiment/finding_words.h"
#include "experiment/markup.h"
#include "experiment/report_words.h"

namespace dcnn {
namespace {

std::string shown(const Json& value) {
  if (value.is_null()) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value.get<double>());
  return text;
}

std::string share_text(const Json& value) {
  return value.is_null() ? "" : percent(value.get<double>());
}

/// Rows of the table of errors: keys of `fit` and what they are called.
std::vector<std::pair<std::string, std::string>> stages_of(const Json& fit) {
  const bool theirs = !fit.value("holdout_noise_floor", Json()).is_null();
  return {{"holdout_rms_measured", "measured, about its mean"},
          {"holdout_rmse_before", "as given"},
          {"holdout_rmse_parameters", "its parameters refitted, no effect"},
          {"holdout_rmse_after", "with all findings"},
          {theirs ? "holdout_noise_floor" : "noise_floor", "sensor's noise"}};
}

/// The unit of the target of this name.
std::string unit_of_target(const Json& report, const Json& target) {
  for (std::size_t j = 0; j < report["targets"].size(); ++j) {
    if (plain_text(report["targets"][j]) == plain_text(target))
      return plain_text(report["units"][j]);
  }
  return "";
}

/// The unit of all targets; empty where they have several.
std::string one_unit(const Json& report) {
  const auto units = report["units"].get<std::vector<std::string>>();
  return std::set<std::string>(units.begin(), units.end()).size() == 1 ? units.front() : "";
}

/// "3.2 g", or where the effect has no size of its own the root mean square that it would add.
std::string least_size(const Json& report, const Json& entry) {
  if (entry.contains("least") && entry["least"].is_object()) {
    const Json& least = entry["least"];
    const std::string effect = plain_text(entry["effect"]), name = plain_text(least["parameter"]);
    return words_of_parameter(effect, name) + ": " +
           with_unit(least["value"].get<double>(),
                     unit_in_words(effect, name, plain_text(least["unit"])));
  }
  return with_unit(entry["minimum_detectable_rms"].get<double>(), one_unit(report)) + " rms";
}

}  // namespace

void add_errors(const Json& report, HtmlReport& page) {
  const Json& fit = report["fit"];
  const auto stages = stages_of(fit);
  std::vector<int> decimals;
  for (std::size_t j = 0; j < report["targets"].size(); ++j) {
    std::vector<double> column;
    for (const auto& [key, label] : stages) {
      if (fit.contains(key) && !fit[key].is_null() && !fit[key][j].is_null())
        column.push_back(fit[key][j].get<double>());
    }
    decimals.push_back(common_decimals(column, 3));
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& [key, label] : stages) {
    if (!fit.contains(key) || fit[key].is_null()) continue;
    std::vector<std::string> row{label};
    for (std::size_t j = 0; j < decimals.size(); ++j) {
      row.push_back(fit[key][j].is_null() ? "" : fixed(fit[key][j].get<double>(), decimals[j]));
    }
    rows.push_back(row);
  }
  std::vector<std::string> header{"RMSE on held-out data"};
  for (std::size_t j = 0; j < report["targets"].size(); ++j) {
    header.push_back(plain_text(report["targets"][j]) + " [" +
                     unit_text(plain_text(report["units"][j])) + "]");
  }
  page.table(header, rows);
  page.paragraph("Verdict: " + verdict_in_words(plain_text(report["verdict"])) +
                 ". RMSE: root mean square of measured - simulated over the samples that were held "
                 "out of the fit, without the first and last 0.5 s of each recording.");
}

void add_findings(const Json& report, HtmlReport& page) {
  page.heading("Findings");
  std::vector<std::vector<std::string>> rows;
  for (const Json& f : in_lines(report["findings"])) {
    const auto alternatives = alternatives_in_words(f);
    rows.push_back({words_of_effect(plain_text(f["effect"]), plain_text(f["axis"])),
                    place_in_words(f), joined(numbers_in_words(f), "; "),
                    share_text(f["confidence"]), share_text(f["holdout_gain"]),
                    alternatives.empty() ? "nothing else" : joined(alternatives, ", ")});
  }
  std::string refuted;
  for (const Json& name : report.value("refuted", Json::array())) {
    const std::string axis = plain_text(name["axis"]);
    refuted += (refuted.empty() ? "" : ", ") + words_of_effect(plain_text(name["effect"]), axis) +
               (axis.empty() ? "" : " (" + words_of_axis(axis) + ")");
  }
  if (!refuted.empty()) {
    page.paragraph(
        "Found in the fitted recordings and withdrawn, because the held-out data speak "
        "against it: " +
        refuted + ".");
  }
  if (remains_untried(report)) {
    page.paragraph(
        "The search ended at its limit of computation: what remains may have a name, or another "
        "law, that was not tried.");
  }
  for (const Json& note : report.value("notes", Json::array())) {
    page.paragraph(note.get<std::string>());
  }
  if (rows.empty()) {
    page.paragraph("No effect is named.");
    return;
  }
  page.table({"what is missing", "where and when", "size, with its 95 % interval", "confidence",
              "hold-out gain", "cannot be excluded"},
             rows);
  page.paragraph(
      "Confidence: the probability that the finding is true, after the search over the whole "
      "catalogue and given the held-out data; empty where a test of its own found it. Hold-out "
      "gain: the share of the held-out "
      "RMSE that would come back without this finding, 1 - after / (after without it). Names and "
      "numbers for programs are in report.json.");
}

void add_places(const Json& report, HtmlReport& page) {
  page.heading("Where the simulator as given differs");
  page.paragraph(
      "Excess: what measured - simulated has beyond the sensor's noise, as a root mean square: "
      "sqrt(max(0, mean square - noise²)), in the unit of the target. The shares of each kind of "
      "place (targets, times, conditions, frequencies) are of the excess' energy.");
  std::vector<std::vector<std::string>> rows;
  for (const Json& a : report["where"]["axes"]) {
    rows.push_back({plain_text(a["axis"]), share_text(a["share"]),
                    with_unit(a["excess_rms"].get<double>(), unit_of_target(report, a["axis"]))});
  }
  for (const Json& s : report["where"]["segments"]) {
    rows.push_back({"time " + shown(s["interval_s"][0]) + " to " + shown(s["interval_s"][1]) + " s",
                    share_text(s["share"]),
                    with_unit(s["excess_rms"].get<double>(), one_unit(report))});
  }
  for (const Json& r : report["where"]["regimes"]) {
    rows.push_back({words_of_signal(plain_text(r["signal"])) + ": " + plain_text(r["condition"]),
                    share_text(r["share"]), ""});
  }
  for (const Json& b : report["where"]["bands"]) {
    rows.push_back(
        {shown(b["hz"][0]) + " to " + shown(b["hz"][1]) + " Hz", share_text(b["share"]), ""});
  }
  page.table({"place", "share of the excess", "excess"}, rows);
}

void add_limits(const Json& report, HtmlReport& page) {
  page.heading("What was not found, and from which size on it would have been");
  std::vector<std::vector<std::string>> rows;
  for (const Json& n : report["not_detected"]) {
    rows.push_back({words_of_effect(plain_text(n["effect"])), least_size(report, n), ""});
  }
  for (const Json& n : report["not_testable"]) {
    rows.push_back({words_of_effect(plain_text(n["effect"])), "", plain_text(n["why"])});
  }
  page.table({"effect", "would have been found from", "not testable because"}, rows);
  page.paragraph(
      "Sizes hold for the axis on which the effect shows least. They are those that would be found "
      "in nine of ten recordings like these; rms: root mean square of what the effect adds.");
}

}  // namespace dcnn
