#include "dcnn/experiment/challenge_report.h"

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "dcnn/core/file.h"
#include "dcnn/experiment/report.h"

namespace dcnn {
namespace {

using Columns = std::vector<std::pair<std::string, std::string>>;  // key, heading

const Columns kHeadline{{"top1", "first name is right"},
                        {"set", "all named, nothing else"},
                        {"class_set", "the same, alternatives count"},
                        {"found", "effects named"},
                        {"found_class", "effects named or among the alternatives"},
                        {"false_discovery", "false names among all names"},
                        {"null_specificity", "\"consistent\" where nothing is hidden"},
                        {"null_without_name", "no name where nothing is hidden"},
                        {"abstention", "no name for what has none"},
                        {"verdict", "verdict right"},
                        {"axis", "axis right"},
                        {"interval_overlap", "overlap of intervals"},
                        {"parameter_error", "relative error of a number"},
                        {"coverage", "truth within ci95"},
                        {"after_over_oracle", "hold-out error over the true law's"},
                        {"after_over_floor", "hold-out error over the estimated floor"},
                        {"seconds", "seconds a scenario"},
                        {"ran", "ended without an error"}};

std::string text_of(const char* format, double a, double b = 0.0, double c = 0.0) {
  char text[96];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

/// "97 % [91, 99] of 40", or "median 1.002, 90 % below 1.02".
std::string cell(const Json& value) {
  if (value.is_null()) return "";
  if (value.contains("rate")) {
    if (value["rate"].is_null()) return "";
    return text_of("%.0f %% [%.0f, %.0f]", 100.0 * value["rate"].get<double>(),
                   100.0 * value["low"].get<double>(), 100.0 * value["high"].get<double>()) +
           " of " + value["n"].dump();
  }
  return text_of("%.4g, 90 %% below %.4g", value["median"], value["p90"]);
}

std::vector<std::string> row(const std::string& label, const Json& summary,
                             const Columns& columns) {
  std::vector<std::string> out{label};
  for (const auto& [key, heading] : columns) out.push_back(cell(summary.value(key, Json())));
  return out;
}

void add_table(HtmlReport& page, const std::string& title, const Json& table,
               const Columns& columns) {
  page.heading(title);
  std::vector<std::string> header{""};
  for (const auto& [key, heading] : columns) header.push_back(heading);
  std::vector<std::vector<std::string>> rows;
  for (const auto& [label, summary] : table.items()) rows.push_back(row(label, summary, columns));
  page.table(header, rows);
}

/// Rates of one key over the rows of a table, with their intervals.
void add_rates(HtmlReport& page, const Json& table, const std::string& key,
               const std::string& title) {
  Chart chart{title, "", "rate", {}, {}, false, 720, 320, true};
  Series rates{"rate", {}, {}, {}, Series::Style::kMarkers};
  Series intervals{"middle of the 95 % interval", {}, {}, {}, Series::Style::kMarkers};
  for (const auto& [label, summary] : table.items()) {
    const Json rate = summary.value(key, Json());
    if (rate.is_null() || rate["rate"].is_null()) continue;
    const double low = rate["low"], high = rate["high"];
    rates.x.push_back(static_cast<double>(chart.categories.size()));
    rates.y.push_back(rate["rate"]);
    intervals.x.push_back(rates.x.back());
    intervals.y.push_back(0.5 * (low + high));
    intervals.error.push_back(0.5 * (high - low));
    chart.categories.push_back(label);
  }
  chart.series = {rates, intervals};
  if (!rates.x.empty()) page.chart(chart, "Wilson's 95 % intervals.");
}

/// What a reader should see first: the error before, after, and where it cannot fall further.
void add_holdout(HtmlReport& page, const Json& table) {
  Chart chart{"Held-out error where one effect is hidden, over that of the true law",
              "",
              "ratio (median)",
              {},
              {},
              true,
              720,
              360,
              true};
  for (const auto& [key, label] : Columns{{"before_over_oracle", "simulator as given"},
                                          {"after_over_oracle", "with what was found"},
                                          {"floor_over_oracle", "noise floor (estimated)"}}) {
    Series series{label, {}, {}, {}, Series::Style::kMarkers};
    for (const auto& [effect, summary] : table.items()) {
      const Json ratio = summary.value(key, Json());
      if (ratio.is_null()) continue;
      const auto known = std::find(chart.categories.begin(), chart.categories.end(), effect);
      series.x.push_back(static_cast<double>(known - chart.categories.begin()));
      if (known == chart.categories.end()) chart.categories.push_back(effect);
      series.y.push_back(ratio["median"]);
    }
    chart.series.push_back(series);
  }
  if (!chart.categories.empty())
    page.chart(chart, "1 is the error of the true law at the true pose.");
}

const Columns kComparison{{"top1", "first name"},
                          {"set", "all named, nothing else"},
                          {"false_discovery", "false names"},
                          {"null_without_name", "no name where nothing is hidden"},
                          {"abstention", "no name for what has none"},
                          {"verdict", "verdict"},
                          {"after_over_oracle", "hold-out over the true law's"},
                          {"seconds", "seconds"}};

/// The diagnosis, what is measured by it, and the true law. (Nobody but the diagnosis speaks the
/// verdicts that are scored.)
Json beside_rivals(const Json& scores) {
  Json table{{"dcnn-diagnose", scores["tables"]["all"]}};
  table.update(scores["rivals"]);
  for (const auto& [method, rates] : scores["rivals"].items()) table[method].erase("verdict");
  table["the true law"] = {{"after_over_oracle", {{"median", 1.0}, {"p90", 1.0}}}};
  return table;
}

Json beside_ablations(const Json& scores) {
  Json table{{"complete", scores["tables"]["all"]}};
  for (const auto& [part, rates] : scores["ablations"].items()) table["without " + part] = rates;
  return table;
}

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

/// The same as lines: one method a row, rates in per cent, medians.
std::string comparison_text(const Json& table) {
  const Columns columns{{"top1", "first"},
                        {"set", "set"},
                        {"false_discovery", "false"},
                        {"null_without_name", "nulls"},
                        {"verdict", "verdict"},
                        {"after_over_oracle", "hold-out"},
                        {"seconds", "seconds"}};
  std::string text(28, ' ');
  for (const auto& [key, heading] : columns)
    text += std::string(10 - heading.size(), ' ') + heading;
  for (const auto& [label, rates] : table.items()) {
    std::string line = label;
    line.resize(28, ' ');
    for (const auto& [key, heading] : columns) {
      const Json value = rates.value(key, Json());
      std::string said;
      if (value.contains("rate") && !value["rate"].is_null()) {
        said = text_of("%.0f %%", 100.0 * value["rate"].get<double>());
      } else if (value.contains("median")) {
        said = text_of("%.4g", value["median"]);
      }
      line += std::string(10 - std::min<std::size_t>(10, said.size()), ' ') + said;
    }
    text += "\n" + line;
  }
  return text + "\n";
}

std::string joined(const Json& names) {
  std::string text;
  for (const Json& name : names) text += (text.empty() ? "" : ", ") + name.get<std::string>();
  return text.empty() ? "nothing" : text;
}

/// What was hidden and what was said of it.
std::string story(const Json& s) {
  std::string hidden;
  for (const Json& e : s["effects"]) {
    hidden += (hidden.empty() ? "" : ", ") + e["effect"].get<std::string>() +
              text_of(" (%.2g of the noise)", e["amplitude"]);
  }
  std::string text = s["id"].get<std::string>() +
                     "  hidden:  " + (hidden.empty() ? "nothing" : hidden) +
                     "\n       named:   " + joined(s["named"]) +
                     "\n       verdict: " + s["verdict"].get<std::string>() + "\n";
  const Json& error = s["holdout"];
  if (error.contains("after") && error.contains("oracle")) {
    text += text_of("       held-out error %.3g N, with what was found %.3g N; ", error["before"],
                    error["after"]) +
            text_of("the true law fitted leaves %.3g N\n", error["oracle"]);
  }
  return text;
}

void add_failures(HtmlReport& page, const Json& scenarios) {
  page.heading("Where it fails");
  std::vector<std::vector<std::string>> rows;
  for (const Json& s : scenarios) {
    if (s["verdict_right"].get<bool>() && s["false_names"] == 0 &&
        (s["class_set"].get<bool>() || s["group"] == "unlisted" || s["group"] == "faint")) {
      continue;
    }
    rows.push_back({s["id"], s["drawn"], s["hidden"].dump(), s["named"].dump(), s["verdict"],
                    s["seconds"].dump()});
  }
  page.table({"scenario", "drawn", "hidden", "named", "verdict", "seconds"}, rows);
}

}  // namespace

std::string challenge_text(const Json& scores) {
  std::string text = std::to_string(scores["scenarios"].size()) + " scenarios of seed " +
                     scores["seed"].dump() + ", sealed " + scores["sha256"].get<std::string>() +
                     "\n";
  constexpr std::size_t kFew = 5;
  if (scores["scenarios"].size() <= kFew) {
    for (const Json& s : scores["scenarios"]) text += story(s);
    return text;
  }
  for (const auto& [key, heading] : kHeadline) {
    const std::string value = cell(scores["tables"]["all"].value(key, Json()));
    if (value.empty()) continue;
    std::string label = heading;
    label.resize(46, ' ');
    text += label + value + "\n";
  }
  if (!scores["missing"].empty()) {
    text += std::to_string(scores["missing"].size()) + " scenarios are not yet run\n";
  }
  if (!scores["rivals"].empty()) text += "\n" + comparison_text(beside_rivals(scores));
  if (!scores["ablations"].empty()) text += "\n" + comparison_text(beside_ablations(scores));
  return text;
}

std::string challenge_html(const Json& scores) {
  HtmlReport page("Sealed challenge");
  page.preformatted(challenge_text(scores));
  page.paragraph(
      "Rates with Wilson's 95 % intervals. The answers were sealed before the first diagnosis; "
      "their "
      "SHA-256 is above. Amplitudes are the rms of what an effect alone changes on its strongest "
      "axis, in standard deviations of the sensor noise.");
  const Json& tables = scores["tables"];
  add_holdout(page, tables["effect"]);
  add_rates(page, tables["effect"], "found_class", "Effects named or among the alternatives");
  add_rates(page, tables["amplitude"], "found_class",
            "Effects named or among the alternatives, by amplitude");
  add_comparisons(page, scores);
  const Columns effects{{"found", "named"},
                        {"found_class", "or an alternative"},
                        {"axis", "axis"},
                        {"interval_overlap", "overlap of intervals"},
                        {"parameter_error", "relative error of a number"},
                        {"coverage", "truth within ci95"}};
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
  add_table(page, "By motion", tables["motion"], groups);
  add_table(page, "By noise", tables["noise"], groups);
  add_failures(page, scores["scenarios"]);
  return page.html();
}

void write_challenge(const std::filesystem::path& folder, const Json& scores) {
  write_file(folder / "scores.json", scores.dump(1) + "\n");
  write_file(folder / "report.html", challenge_html(scores));
}

}  // namespace dcnn
