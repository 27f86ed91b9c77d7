// SPDX-License-Identifier: Apache-2.0
// The diagnosis on a terminal: the words and units of the page.
#include <sstream>

#include "dcnn/core/number.h"
#include "dcnn/experiment/diagnosis_report.h"
#include "dcnn/physics/effect_words.h"
#include "experiment/finding_words.h"
#include "experiment/markup.h"
#include "experiment/report_words.h"

namespace dcnn {
namespace {

constexpr int kTextIndent = 12, kTextWidth = 96;

/// Parts side by side, as many as fit in a line; further lines are indented.
std::string in_columns(const std::vector<std::string>& parts) {
  std::string text;
  int column = kTextIndent;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::string part = parts[k] + (k + 1 < parts.size() ? ";" : "");
    const int width = character_count(part) + 1;
    if (k > 0 && column + width > kTextWidth) {
      text += "\n" + std::string(kTextIndent, ' ');
      column = kTextIndent;
    } else if (k > 0) {
      text += " ";
    }
    text += part;
    column += width;
  }
  return text;
}

std::string finding_text(const Json& finding) {
  const std::string place = place_in_words(finding), indent(kTextIndent, ' ');
  std::string text = words_of_effect(plain_text(finding["effect"]), plain_text(finding["axis"]));
  if (!place.empty()) text += ", " + place;
  if (!finding["confidence"].is_null()) {
    text += "; confidence " + percent(finding["confidence"].get<double>());
  }
  text += "\n";
  const auto numbers = numbers_in_words(finding);
  if (!numbers.empty()) text += indent + in_columns(numbers) + "\n";
  const auto others = alternatives_in_words(finding);
  if (!others.empty()) text += indent + "or: " + joined(others, ", ") + "\n";
  return text;
}

/// Over the targets that have the first one's unit: newtons and newton metres have no mean.
double mean_of(const Json& report, const Json& list) {
  double sum = 0.0, count = 0.0;
  for (std::size_t j = 0; j < list.size(); ++j) {
    if (list[j].is_null() || report["units"][j] != report["units"][0]) continue;
    sum += list[j].get<double>();
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

/// " N (mean of fx, fy, fz)".
std::string of_what(const Json& report) {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < report["units"].size(); ++j) {
    if (report["units"][j] == report["units"][0]) names.push_back(plain_text(report["targets"][j]));
  }
  return " " + unit_text(plain_text(report["units"][0])) +
         (names.size() == 1 ? " (" : " (mean of ") + joined(names, ", ") + ")\n";
}

std::string errors_text(const Json& report) {
  const Json& fit = report["fit"];
  const auto mean = [&](const Json& list) { return brief(mean_of(report, list)); };
  if (fit["holdout_rmse_before"].is_null()) {
    return "none, sensor's noise " + mean(fit["noise_floor"]) + of_what(report);
  }
  const Json& refitted = fit["holdout_rmse_parameters"];
  return "RMSE " + mean(fit["holdout_rmse_before"]) + " as given, " +
         (refitted.is_null() ? "" : mean(refitted) + " with its parameters refitted, ") +
         mean(fit["holdout_rmse_after"]) + " with all findings; sensor's noise " +
         mean(heldout_noise(fit)) + of_what(report);
}

/// Sample by sample the derivative of the pose lags or is noisy.
std::string online_text(const Json& report) {
  const Json online = report["fit"].value("online", Json());
  if (online.is_null()) return "";
  return "online      RMSE " + brief(mean_of(report, online["holdout_rmse"])) +
         " of the same sample by sample (dcnn-run), by a causal derivative over " +
         brief(1e3 * online["derivative"]["window_s"].get<double>()) + " ms\n";
}

/// Stretches that were left out, and what reading made of the recordings.
std::string notes_text(const Json& report) {
  std::string text;
  for (const Json& note : report.value("notes", Json::array())) {
    text += "note        " + plain_text(note) + "\n";
  }
  for (const Json& stretch : report.value("left_out", Json::array())) {
    text += "left out    " + brief(stretch["interval_s"][0].get<double>()) + " to " +
            brief(stretch["interval_s"][1].get<double>()) + " s of " +
            plain_text(stretch["recording"]) +
            ": far more is left there than elsewhere, as by a collision or a hand\n";
  }
  return text;
}

}  // namespace

std::string to_text(const Diagnosis& diagnosis) {
  const Json& report = diagnosis.report;
  std::ostringstream out;
  out << headline(report) << "\n\n";
  out << "verdict     " << verdict_in_words(plain_text(report["verdict"])) << "\n";
  if (report.contains("zeroed")) {
    out << "zeroed      an offset of its own was estimated for each of " << report["zeroed"].size()
        << " recordings: a constant offset has no name\n";
  }
  for (const Json& finding : in_lines(report["findings"])) {
    out << (is_doubtful(finding) ? "doubtful    " : "found       ") << finding_text(finding);
  }
  out << notes_text(report);
  if (remains_untried(report)) {
    out << "search      ended at its limit of computation: what remains may have a name, or "
           "another "
           "law, that was not tried\n";
  }
  out << "hold-out    " << errors_text(report) << online_text(report);
  const Json& next = report["next_motion"];
  if (!next.is_null()) {
    out << "next        " << question_in_words(next) << ": " << plain_text(next["words"]) << "\n";
  }
  return out.str();
}

}  // namespace dcnn
