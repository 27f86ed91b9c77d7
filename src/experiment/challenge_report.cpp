// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/challenge_report.h"

#include <algorithm>

#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/experiment/report.h"
#include "dcnn/physics/effect_words.h"
#include "experiment/challenge_tables.h"

namespace dcnn {
namespace {

std::vector<std::string> row(const std::string& label, const Json& summary,
                             const Columns& columns) {
  std::vector<std::string> out{label};
  for (const auto& [key, heading] : columns) out.push_back(score_text(summary.value(key, Json())));
  return out;
}

void add_table(HtmlReport& page, const std::string& title, const Json& table,
               const Columns& columns) {
  page.heading(title);
  std::vector<std::string> header{""};
  for (const auto& [key, heading] : columns) header.push_back(heading);
  std::vector<std::vector<std::string>> rows;
  for (const auto& [label, summary] : table.items()) {
    rows.push_back(row(words_of_effect(label), summary, columns));
  }
  page.table(header, rows);
}

/// Rates of one key over the rows of a table, with their intervals.
void add_rates(HtmlReport& page, const Json& table, const std::string& key,
               const std::string& title) {
  Chart chart{title, "", "rate", {}, {}, false, 720, 320};
  chart.legend = false;
  Series rates{"rate", {}, {}, {}, Series::Style::kMarkers};
  for (const auto& [label, summary] : table.items()) {
    const Json rate = summary.value(key, Json());
    if (rate.is_null() || rate["rate"].is_null()) continue;
    const double low = rate["low"], high = rate["high"];
    rates.x.push_back(static_cast<double>(chart.categories.size()));
    rates.y.push_back(rate["rate"]);
    rates.middle.push_back(0.5 * (low + high));
    rates.error.push_back(0.5 * (high - low));
    chart.categories.push_back(words_of_effect(label));
  }
  chart.series = {rates};
  if (!rates.x.empty()) page.chart(chart, "Bars: Wilson's 95 % intervals.");
}

/// What a reader should see first: the error before, after, and where it cannot fall further.
Chart holdout_chart(const Json& table) {
  Chart chart{"Held-out error where one effect is hidden, over that of the true law",
              "",
              "ratio (median)",
              {},
              {},
              true,
              1200,
              420,
              true};
  for (const auto& [key, label] : Columns{{"before_over_oracle", "simulator as given"},
                                          {"after_over_oracle", "with what was found"},
                                          {"floor_over_oracle", "noise floor (estimated)"}}) {
    Series series{label, {}, {}, {}, Series::Style::kMarkers};
    for (const auto& [effect, summary] : table.items()) {
      const Json ratio = summary.value(key, Json());
      if (ratio.is_null()) continue;
      const std::string words = words_of_effect(effect);
      const auto known = std::find(chart.categories.begin(), chart.categories.end(), words);
      series.x.push_back(static_cast<double>(known - chart.categories.begin()));
      if (known == chart.categories.end()) chart.categories.push_back(words);
      series.y.push_back(ratio["median"]);
    }
    chart.series.push_back(series);
  }
  return chart;
}

const Columns kComparison{{"top1", "first name"},
                          {"set", "all named, nothing else"},
                          {"false_discovery", "false names"},
                          {"null_without_name", "no name where nothing is hidden"},
                          {"abstention", "no name for what has none"},
                          {"verdict", "verdict"},
                          {"after_over_oracle", "hold-out over the true law's"},
                          {"seconds", "seconds"}};

void add_comparisons(HtmlReport& page, const Json& scores) {
  if (!scores["rivals"].empty()) {
    add_table(page, "Beside other methods on the same files and answers", beside_rivals(scores),
              kComparison);
  }
  if (!scores["ablations"].empty()) {
    add_table(page, "What each part of the diagnosis is worth", beside_ablations(scores),
              kComparison);
  }
}

std::string effects_in_words(const Json& ids) {
  Json names = Json::array();
  for (const Json& id : ids) names.push_back(words_of_effect(id.get<std::string>()));
  return joined_names(names);
}

/// How often the first name was right, and how often nothing was named where nothing was hidden.
std::string challenge_answer(const Json& scores) {
  const std::size_t count = scores["scenarios"].size();
  std::string text = "Of " + std::to_string(count) + " sealed scenario" + (count == 1 ? "" : "s") +
                     " of seed " + scores["seed"].dump();
  const std::string first = score_text(scores["tables"]["all"].value("top1", Json())),
                    silent = score_text(scores["tables"]["all"].value("null_without_name", Json()));
  if (!first.empty()) text += ", the first name is right in " + first;
  if (!silent.empty()) text += first.empty() ? ", " : "; ";
  if (!silent.empty()) text += "where nothing is hidden, nothing is named in " + silent;
  return text + " (95 % intervals in brackets).";
}

void add_failures(HtmlReport& page, const Json& scenarios) {
  page.heading("Where it fails");
  std::vector<std::vector<std::string>> rows;
  for (const Json& s : scenarios) {
    if (s["verdict_right"].get<bool>() && s["false_names"] == 0 &&
        (s["class_set"].get<bool>() || s["group"] == "unlisted" || s["group"] == "faint")) {
      continue;
    }
    rows.push_back({s["id"], s["drawn"], effects_in_words(s["hidden"]),
                    effects_in_words(s["named"]), s["verdict"], s["seconds"].dump()});
  }
  if (rows.empty()) {
    page.paragraph("Nowhere: every name and every verdict is right.");
    return;
  }
  page.table({"scenario", "drawn", "hidden", "named", "verdict", "seconds"}, rows);
}

}  // namespace

std::string challenge_html(const Json& scores) {
  HtmlReport page("Sealed challenge");
  page.paragraph(challenge_answer(scores));
  const Json& tables = scores["tables"];
  const Chart holdout = holdout_chart(tables["effect"]);
  if (!holdout.categories.empty()) {
    page.chart(holdout, "1 is the error of the true law at the true pose.");
  }
  page.table({"over all scenarios", "rate with its interval, or median"}, headline_rows(scores));
  page.paragraph(
      "Rates with Wilson's 95 % intervals. The answers were sealed before the first diagnosis; "
      "their "
      "SHA-256 is " +
      scores["sha256"].get<std::string>() +
      ". Amplitudes are the rms of what an effect alone changes on its strongest "
      "axis, in standard deviations of the sensor noise.");
  page.heading("Rates by effect and by amplitude");
  add_rates(page, tables["effect"], "found_class", "Effects named or among the alternatives");
  add_rates(page, tables["amplitude"], "found_class",
            "Effects named or among the alternatives, by amplitude");
  add_comparisons(page, scores);
  const Columns effects{{"found", "named"},
                        {"found_class", "or an alternative"},
                        {"axis", "axis"},
                        {"interval_overlap", "overlap of intervals"},
                        {"parameter_error", "relative error of a number"},
                        {"coverage", "truth within the 95 % interval"}};
  add_table(page, "By effect", tables["effect"], effects);
  add_table(page, "By amplitude", tables["amplitude"], effects);
  const Columns groups{{"set", "all named, nothing else"},
                       {"class_set", "the same, alternatives count"},
                       {"false_discovery", "false names"},
                       {"null_specificity", "\"consistent\" where nothing is hidden"},
                       {"null_without_name", "no name there"},
                       {"abstention", "no name for what has none"},
                       {"verdict", "verdict"},
                       {"after_over_oracle", "hold-out over the true law's"}};
  add_table(page, "By group", tables["group"], groups);
  add_table(page, "By family of conditions", tables["family"], groups);
  add_table(page, "By motion", tables["motion"], groups);
  add_table(page, "By noise", tables["noise"], groups);
  add_failures(page, scores["scenarios"]);
  page.heading("As text");
  page.preformatted(challenge_text(scores));
  return page.html();
}

void write_challenge(const std::filesystem::path& folder, const Json& scores) {
  FileSet files(folder);
  files.replaces("holdout.svg");
  write_file(folder / "scores.json", scores.dump(1) + "\n");
  write_file(folder / "report.html", challenge_html(scores));
  const Chart holdout = holdout_chart(scores["tables"]["effect"]);
  if (!holdout.categories.empty()) write_file(folder / "holdout.svg", to_svg(holdout));
  files.commit();
}

}  // namespace dcnn
