#include "dcnn/experiment/diagnosis_report.h"

#include <algorithm>
#include <set>

#include "dcnn/core/file.h"
#include "dcnn/data/csv.h"
#include "dcnn/experiment/report.h"
#include "experiment/series.h"

namespace dcnn {
namespace {

std::string shown(const Json& value) {
  if (value.is_null()) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value.get<double>());
  return text;
}

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.is_null() ? "" : value.dump();
}

const std::vector<std::pair<const char*, const char*>> kStages{
    {"holdout_rmse_before", "as given"},
    {"holdout_rmse_parameters", "own numbers refitted"},
    {"holdout_rmse_after", "with all findings"},
    {"noise_floor", "sensor's noise"}};

/// The errors of the targets that share a unit.
Chart error_chart(const Json& report, const std::string& unit) {
  Chart chart{"RMSE on held-out data", "", "RMSE [" + unit + "]", {}, {}, false, 720, 280, true};
  for (const auto& [key, label] : kStages) {
    const Json& values = report["fit"][key];
    if (values.is_null()) continue;
    Series series{label, {}, {}, {}, Series::Style::kMarkers};
    for (std::size_t j = 0; j < values.size(); ++j) {
      if (text_of(report["units"][j]) != unit || values[j].is_null()) continue;
      series.x.push_back(static_cast<double>(series.x.size()));
      series.y.push_back(values[j].get<double>());
    }
    chart.series.push_back(series);
  }
  for (std::size_t j = 0; j < report["targets"].size(); ++j) {
    if (text_of(report["units"][j]) == unit) chart.categories.push_back(text_of(report["targets"][j]));
  }
  return chart;
}

void add_errors(const Json& report, HtmlReport& page) {
  page.heading("Error on held-out data");
  const Json& fit = report["fit"];
  std::vector<std::vector<std::string>> rows;
  for (const auto& [key, label] : kStages) {
    if (fit[key].is_null()) continue;
    std::vector<std::string> row{label};
    for (const Json& value : fit[key]) row.push_back(shown(value));
    rows.push_back(row);
  }
  std::vector<std::string> header{"RMSE"};
  for (std::size_t j = 0; j < report["targets"].size(); ++j) {
    header.push_back(text_of(report["targets"][j]) + " [" + text_of(report["units"][j]) + "]");
  }
  const auto units = report["units"].get<std::vector<std::string>>();
  for (const std::string& unit : std::set<std::string>(units.begin(), units.end())) {
    page.chart(error_chart(report, unit),
               "The first and last 0.5 s of each recording are left out.");
  }
  page.table(header, rows);
}

/// An identifier as words: "coulomb_friction" is "coulomb friction".
std::string in_words(std::string id) {
  std::replace(id.begin(), id.end(), '_', ' ');
  return id;
}

void add_findings(const Json& report, HtmlReport& page) {
  page.heading("Findings");
  std::vector<std::vector<std::string>> rows;
  for (const Json& f : report["findings"]) {
    std::string parameters;
    for (const auto& [name, p] : f["parameters"].items()) {
      parameters += (parameters.empty() ? "" : "; ") + name + " = " + shown(p["value"]) + " [" +
                    shown(p["ci95"][0]) + ", " + shown(p["ci95"][1]) + "] " +
                    p["unit"].get<std::string>();
    }
    std::string alternatives;
    for (const Json& a : f["alternatives"]) {
      const Json& effect = a.is_object() ? a["effect"] : a;
      alternatives += (alternatives.empty() ? "" : ", ") + in_words(text_of(effect));
    }
    rows.push_back({in_words(text_of(f["effect"])), in_words(text_of(f["axis"])), parameters, shown(f["confidence"]),
                    shown(f["holdout_gain"]), alternatives});
  }
  if (rows.empty()) {
    page.paragraph("No effect is named.");
    return;
  }
  page.table({"effect", "axis", "parameters with 95 % intervals", "confidence", "hold-out gain",
              "cannot be excluded"},
             rows);
  page.paragraph(
      "Confidence: the probability that the finding is true, after the search over the whole "
      "catalogue. Hold-out gain: the share of the held-out RMSE that would come back without this "
      "finding, 1 - after / (after without it).");
}

void add_portraits(const Diagnosis& diagnosis, HtmlReport& page) {
  if (diagnosis.portraits.empty()) return;
  page.heading("Each finding in its own coordinate");
  for (const Portrait& p : diagnosis.portraits) {
    Chart chart{p.title, p.x_label, p.y_label, {}, {}, false, 720, 320};
    chart.series.push_back({"left without it", p.x, p.left, {}, Series::Style::kMarkers});
    std::vector<std::size_t> order(p.x.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return p.x[a] < p.x[b]; });
    Series law{"the law", {}, {}, {}, Series::Style::kMarkers};
    for (const std::size_t i : order) {
      law.x.push_back(p.x[i]);
      law.y.push_back(p.law[i]);
    }
    chart.series.push_back(law);
    page.chart(chart, "Means over 20 ms of what the model without this finding leaves.");
  }
}

/// First row and number of rows without the first and last 0.5 s; all of a recording too short.
std::pair<Eigen::Index, Eigen::Index> scored_rows(const Eigen::VectorXd& t) {
  constexpr double kEnd = 0.5;  // s
  const auto first = std::lower_bound(t.begin(), t.end(), t[0] + kEnd) - t.begin();
  const auto last = std::upper_bound(t.begin(), t.end(), t[t.size() - 1] - kEnd) - t.begin();
  return last > first ? std::pair(first, last - first) : std::pair<Eigen::Index, Eigen::Index>(0, t.size());
}

void add_traces(const Diagnosis& diagnosis, HtmlReport& page) {
  if (diagnosis.holdout.empty()) return;
  page.heading("Held-out recording, before and after");
  const HeldOut& record = diagnosis.holdout.front();
  const auto [from, rows] = scored_rows(record.t);
  const std::vector<double> t = list_of(record.t.segment(from, rows));
  for (Eigen::Index j = 0; j < record.measured.cols(); ++j) {
    const auto& target = diagnosis.report["targets"][static_cast<std::size_t>(j)];
    const auto& unit = diagnosis.report["units"][static_cast<std::size_t>(j)];
    Chart chart{target.get<std::string>() + ": measured - simulated",
                "time [s]",
                "difference [" + unit.get<std::string>() + "]",
                {},
                {},
                false,
                720,
                240};
    const Eigen::VectorXd before = (record.measured.col(j) - record.before.col(j)).segment(from, rows);
    const Eigen::VectorXd after = (record.measured.col(j) - record.after.col(j)).segment(from, rows);
    chart.series.push_back({"as given", t, list_of(before), {}});
    chart.series.push_back({"with all findings", t, list_of(after), {}});
    page.chart(chart, record.recording + ", without the ends that the score leaves out");
  }
}

void add_places(const Json& report, HtmlReport& page) {
  page.heading("Where the simulator as given differs");
  std::vector<std::vector<std::string>> rows;
  for (const Json& a : report["where"]["axes"]) {
    rows.push_back({"axis " + text_of(a["axis"]), shown(a["share"]), shown(a["excess_rms"])});
  }
  for (const Json& s : report["where"]["segments"]) {
    rows.push_back({"time " + shown(s["interval_s"][0]) + " to " + shown(s["interval_s"][1]) + " s",
                    shown(s["share"]), shown(s["excess_rms"])});
  }
  for (const Json& r : report["where"]["regimes"]) {
    rows.push_back({text_of(r["signal"]) + ": " + text_of(r["condition"]), shown(r["share"]), ""});
  }
  for (const Json& b : report["where"]["bands"]) {
    rows.push_back({shown(b["hz"][0]) + " to " + shown(b["hz"][1]) + " Hz", shown(b["share"]), ""});
  }
  page.table({"place", "share of the excess", "excess rms"}, rows);
}

void add_budget(const Json& report, HtmlReport& page) {
  const Json& parts = report["where"]["budget"];
  if (parts.empty()) return;
  page.heading("Of what kind the difference is");
  Chart chart{"Share of the difference's energy", "", "share", {}, {}, false, 720, 240};
  chart.legend = false;
  Series shares{"share", {}, {}, {}, Series::Style::kBars};
  for (const Json& part : parts) {
    const std::string name = text_of(part["part"]);
    const auto known = std::find(chart.categories.begin(), chart.categories.end(), name);
    const auto at = static_cast<std::size_t>(known - chart.categories.begin());
    if (known == chart.categories.end()) {
      chart.categories.push_back(name);
      shares.x.push_back(static_cast<double>(at));
      shares.y.push_back(0.0);
    }
    shares.y[at] += part["share"].get<double>();  // of all axes of a machine
  }
  chart.series.push_back(shares);
  page.chart(
      chart,
      "Of the simulator as given, each beside those to its left: its own numbers; functions of "
      "rates and angles; of where the motion came from; of the time; pushes. Counted where "
      "nothing was fitted.");
}

void add_limits(const Json& report, HtmlReport& page) {
  page.heading("What was not found, and from which size on it would have been");
  std::vector<std::vector<std::string>> rows;
  for (const Json& n : report["not_detected"]) {
    rows.push_back({in_words(text_of(n["effect"])), shown(n["minimum_detectable_rms"]), ""});
  }
  for (const Json& n : report["not_testable"]) {
    rows.push_back({in_words(text_of(n["effect"])), "", text_of(n["why"])});
  }
  page.table({"effect", "least detectable rms [unit of the target]", "not testable because"}, rows);
}

}  // namespace

std::string to_html(const Diagnosis& diagnosis) {
  const Json& report = diagnosis.report;
  HtmlReport page("Diagnosis: what the simulator leaves out");
  page.paragraph(headline(report));
  page.paragraph("Verdict: " + report["verdict"].get<std::string>() + ".");
  add_errors(report, page);
  add_findings(report, page);
  add_portraits(diagnosis, page);
  add_traces(diagnosis, page);
  add_budget(report, page);
  add_places(report, page);
  add_limits(report, page);
  if (!report["next_motion"].is_null()) {
    page.heading("Next motion");
    page.paragraph("To tell " + text_of(report["next_motion"]["separates"][0]) + " from " +
                   text_of(report["next_motion"]["separates"][1]) + ": " +
                   text_of(report["next_motion"]["words"]) + ".");
  }
  return page.html();
}

void write_diagnosis(const std::filesystem::path& folder, const Diagnosis& diagnosis) {
  const auto targets = diagnosis.report["targets"].get<std::vector<std::string>>();
  const bool blocks = diagnosis.report["holdout_recordings"].empty();
  for (std::size_t k = 0; k < diagnosis.holdout.size(); ++k) {
    const HeldOut& record = diagnosis.holdout[k];
    Table table;
    table.columns = {"t"};
    table.columns.insert(table.columns.end(), targets.begin(), targets.end());
    const Eigen::Index width = record.after.cols();
    table.values.resize(record.after.rows(), 1 + width + (blocks ? 1 : 0));
    table.values.col(0) = record.t;
    table.values.middleCols(1, width) = record.after;
    if (blocks) {
      table.columns.push_back("held_out");
      for (Eigen::Index i = 0; i < record.after.rows(); ++i) {
        table.values(i, 1 + width) = record.held[static_cast<std::size_t>(i)];
      }
    }
    write_csv(folder / ("holdout_" + std::to_string(k) + "_pred.csv"), table);
  }
  write_file(folder / "model.json", diagnosis.model.dump(2) + "\n");
  write_file(folder / "report.json", diagnosis.report.dump(2) + "\n");
  write_file(folder / "report.html", to_html(diagnosis));
}

}  // namespace dcnn
