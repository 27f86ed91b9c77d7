// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/diagnosis_report.h"

#include <algorithm>

#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/core/number.h"
#include "dcnn/data/csv.h"
#include "dcnn/experiment/report.h"
#include "dcnn/physics/effect_words.h"
#include "experiment/diagnosis_tables.h"
#include "experiment/finding_words.h"
#include "experiment/report_words.h"
#include "experiment/series.h"

namespace dcnn {
namespace {

void add_portraits(const Diagnosis& diagnosis, HtmlReport& page) {
  if (diagnosis.portraits.empty()) return;
  page.heading("Each finding in its own coordinate");
  for (const Portrait& p : diagnosis.portraits) {
    Chart chart{words_of_effect(p.title), p.x_label, p.y_label, {}, {}, false, 720, 320};
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
  return last > first ? std::pair(first, last - first)
                      : std::pair<Eigen::Index, Eigen::Index>(0, t.size());
}

/// The difference of one target on the first held-out recording, as given and with all findings.
Chart difference_chart(const Diagnosis& diagnosis, Eigen::Index j) {
  const HeldOut& record = diagnosis.holdout.front();
  const auto [from, rows] = scored_rows(record.t);
  const auto& target = diagnosis.report["targets"][static_cast<std::size_t>(j)];
  const auto& unit = diagnosis.report["units"][static_cast<std::size_t>(j)];
  Chart chart{plain_text(target) + ": measured - simulated",
              "time [s]",
              "difference [" + unit_text(plain_text(unit)) + "]",
              {},
              {},
              false,
              720,
              240};
  const std::vector<double> t = list_of(record.t.segment(from, rows));
  const Eigen::VectorXd before =
      (record.measured.col(j) - record.before.col(j)).segment(from, rows);
  const Eigen::VectorXd after = (record.measured.col(j) - record.after.col(j)).segment(from, rows);
  if (before == after) {
    chart.series.push_back({"as given, and with all findings", t, list_of(before), {}});
  } else {
    chart.series.push_back({"as given", t, list_of(before), {}});
    chart.series.push_back({"with all findings", t, list_of(after), {}});
  }
  return chart;
}

/// The target whose held-out error falls most, or where nothing was found exceeds its noise most.
std::size_t telling_target(const Json& fit) {
  const auto at = [&](const char* key, std::size_t j) {
    const Json& value = fit[key].is_null() ? fit[key] : fit[key][j];
    return value.is_null() ? 1.0 : std::max(1e-12, value.get<double>());
  };
  std::size_t best = 0;
  double most = 0.0;
  for (std::size_t j = 0; j < fit["noise_floor"].size(); ++j) {
    const double gain = at("holdout_rmse_before", j) / at("holdout_rmse_after", j);
    if (gain > most) most = gain, best = j;
  }
  return best;
}

void add_picture(const Diagnosis& diagnosis, HtmlReport& page) {
  if (diagnosis.holdout.empty()) return;
  const auto j = static_cast<Eigen::Index>(telling_target(diagnosis.report["fit"]));
  page.chart(difference_chart(diagnosis, j), "Held-out recording " +
                                                 diagnosis.holdout.front().recording +
                                                 ", without the ends that the score leaves out.");
}

void add_traces(const Diagnosis& diagnosis, HtmlReport& page) {
  if (diagnosis.holdout.empty()) return;
  const auto shown_first = static_cast<Eigen::Index>(telling_target(diagnosis.report["fit"]));
  if (diagnosis.holdout.front().measured.cols() < 2) return;
  page.heading("The other targets, before and after");
  for (Eigen::Index j = 0; j < diagnosis.holdout.front().measured.cols(); ++j) {
    if (j == shown_first) continue;
    page.chart(difference_chart(diagnosis, j), diagnosis.holdout.front().recording +
                                                   ", without the ends that the score leaves out");
  }
}

void add_budget(const Json& report, HtmlReport& page) {
  const Json& parts = report["where"]["budget"];
  if (parts.empty()) return;
  page.heading("Of what kind the difference is");
  Chart chart{"Share of the difference's energy", "", "share", {}, {}, false, 720, 240};
  chart.legend = false;
  Series shares{"share", {}, {}, {}, Series::Style::kBars};
  for (const Json& part : parts) {
    const std::string name = words_of_part(plain_text(part["part"]));
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
      "Share of the squared difference that each kind of explanation takes beyond those to its "
      "left: "
      "the simulator's own parameters refitted; functions of rates and angles; of the history of the "
      "motion; of the time; external forces. Counted on rows that nothing was fitted to.");
}

}  // namespace

std::string to_html(const Diagnosis& diagnosis) {
  const Json& report = diagnosis.report;
  HtmlReport page("Diagnosis: what the simulator leaves out");
  page.paragraph(headline(report));
  for (const Json& line : report.value("check", Json::array()))
    page.paragraph(line.get<std::string>());
  add_picture(diagnosis, page);
  add_errors(report, page);
  add_findings(report, page);
  add_portraits(diagnosis, page);
  add_traces(diagnosis, page);
  add_budget(report, page);
  add_places(report, page);
  add_limits(report, page);
  if (!report["next_motion"].is_null()) {
    page.heading("Next motion");
    std::string question = question_in_words(report["next_motion"]);
    question[0] = 'T';
    page.paragraph(question + ": " + plain_text(report["next_motion"]["words"]) + ".");
  }
  return page.html();
}

void write_diagnosis(const std::filesystem::path& folder, const Diagnosis& diagnosis) {
  const auto targets = diagnosis.report["targets"].get<std::vector<std::string>>();
  const bool blocks = diagnosis.report["holdout_recordings"].empty();
  FileSet files(folder);
  files.replaces("holdout_*_pred.csv");
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
  files.commit();
}

}  // namespace dcnn
