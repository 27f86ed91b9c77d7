// SPDX-License-Identifier: Apache-2.0
// A bench as JSON, as a table beside the paper's Table I, and as a page.
#include <algorithm>
#include <array>
#include <cstdio>

#include "dcnn/experiment/bench.h"
#include "dcnn/experiment/peers.h"
#include "dcnn/experiment/report.h"
#include "experiment/markup.h"

namespace dcnn {
namespace {

constexpr const char* kPaperNote =
    "Paper: Table I, MATLAB 2018b on another machine (i7 2.80 GHz): never compare absolute values, "
    "only the order within one column.";

/// Table I: mean and standard deviation of a call and of the total [s].
struct PaperRow {
  const char* model;
  Index length;
  double mean, deviation, total, total_deviation;
};

constexpr std::array<PaperRow, 21> kTable{
    {{"cf", 1, 0.0003, 0.00001, 12.19, 0.33},      {"cf", 5, 0.0004, 0.00002, 3.01, 0.20},
     {"cf", 10, 0.0003, 0.00001, 1.07, 0.09},      {"ffnn-s", 1, 0.0044, 0.00006, 165.46, 2.01},
     {"ffnn-s", 5, 0.0046, 0.00020, 33.21, 1.70},  {"ffnn-s", 10, 0.0045, 0.00009, 16.29, 0.36},
     {"cfnn-s", 1, 0.0060, 0.00009, 198.44, 2.92}, {"cfnn-s", 5, 0.0059, 0.00025, 40.71, 1.56},
     {"cfnn-s", 10, 0.0060, 0.00009, 19.49, 0.30}, {"ffnn-m", 1, 0.0067, 0.00008, 215.05, 2.64},
     {"ffnn-m", 5, 0.0068, 0.00027, 43.88, 1.70},  {"ffnn-m", 10, 0.0067, 0.00011, 21.54, 0.36},
     {"cfnn-m", 1, 0.0074, 0.00010, 236.20, 3.36}, {"cfnn-m", 5, 0.0076, 0.00031, 48.66, 1.97},
     {"cfnn-m", 10, 0.0075, 0.00015, 23.93, 0.48}, {"lstm", 1, 0.0112, 0.00038, 357.44, 12.3},
     {"lstm", 5, 0.0117, 0.00061, 74.97, 3.94},    {"lstm", 10, 0.0117, 0.00054, 37.64, 1.75},
     {"dcnn", 1, 0.0031, 0.00002, 100.75, 0.49},   {"dcnn", 5, 0.0056, 0.00016, 35.68, 1.01},
     {"dcnn", 10, 0.0054, 0.00008, 17.34, 0.24}}};

const PaperRow* paper_row(const BenchRow& row) {
  const auto* found = std::find_if(kTable.begin(), kTable.end(), [&](const PaperRow& p) {
    return row.model == p.model && row.length == p.length;
  });
  return found == kTable.end() ? nullptr : found;
}

std::string format(const char* how, double a, double b) {
  char text[64];
  std::snprintf(text, sizeof text, how, a, b);
  return text;
}

/// Microseconds with three digits or more: "0.32", "52.1", "52080".
std::string micro(double seconds) {
  const double us = 1e6 * seconds;
  return fixed(us, us >= 100.0 ? 0 : us >= 10.0 ? 1 : 2);
}

/// "0.32 µs", "52.1 ms", "1.2 s".
std::string time_text(double seconds) {
  if (seconds < 1e-3) return significant(1e6 * seconds, 3) + " µs";
  return seconds < 1.0 ? significant(1e3 * seconds, 3) + " ms" : significant(seconds, 3) + " s";
}

/// What a call is given: features or, with the derivative filter in the call, poses.
std::string begins_at(const BenchRow& row) { return row.features_included ? "pose" : "features"; }

std::vector<std::string> cells(const BenchRow& row) {
  const PaperRow* paper = paper_row(row);
  return {row.file,
          begins_at(row),
          std::to_string(row.length),
          std::to_string(row.calls),
          micro(row.call.mean) + " ± " + micro(row.call.deviation),
          format("%.3f ± %.3f", row.total.mean, row.total.deviation),
          micro(row.p50),
          micro(row.p99),
          micro(row.maximum),
          micro(row.per_sample),
          paper ? format("%.4f ± %.5f", paper->mean, paper->deviation) : "-",
          paper ? format("%.2f ± %.2f", paper->total, paper->total_deviation) : "-"};
}

const std::vector<std::string> kHeader{
    "file",           "from",           "samples a call", "calls",    "call [µs]",
    "total [s]",      "p50 [µs]",       "p99 [µs]",       "max [µs]", "per sample [µs]",
    "paper call [s]", "paper total [s]"};

Chart sample_chart(const Bench& bench) {
  Chart chart;
  chart.title = "time per sample";
  chart.x_label = "samples per call";
  chart.y_label = "time per sample [µs]";
  chart.log_y = true;
  for (const BenchRow& row : bench.rows) {
    const std::string label = row.file + ", from the " + begins_at(row);
    auto series = std::find_if(chart.series.begin(), chart.series.end(),
                               [&](const Series& s) { return s.label == label; });
    if (series == chart.series.end()) {
      chart.series.push_back({label, {}, {}, {}, Series::Style::kLineAndMarkers});
      series = chart.series.end() - 1;
    }
    series->x.push_back(static_cast<double>(row.length));
    series->y.push_back(1e6 * row.per_sample);
  }
  return chart;
}

/// The first row in one sentence.
std::string bench_answer(const BenchRow& row) {
  return row.file + " takes " + time_text(row.p50) + " (median) and at most " +
         time_text(row.maximum) + " for a call of " + std::to_string(row.length) +
         (row.length == 1 ? " sample" : " samples") + " on one thread of this machine.";
}

void add_calls(HtmlReport& page, const Bench& bench, const BenchRequest& request) {
  page.paragraph(bench_answer(bench.rows.front()));
  page.chart(sample_chart(bench), "time per sample over the samples predicted in one call");
  std::vector<std::vector<std::string>> rows;
  for (const BenchRow& row : bench.rows) rows.push_back(cells(row));
  page.table(kHeader, rows);
  page.heading("How it was measured");
  page.paragraph("Mean ± standard deviation over " + std::to_string(request.repetitions) +
                 " repetitions, one pinned thread, monotonic clock, after " +
                 std::to_string(request.warm_up) +
                 " warm-up calls; p50, p99 and max are of single calls. 'features': the call "
                 "begins at the features; "
                 "'pose': it also makes them with the causal derivative filter. Input: " +
                 bench.source + ".");
  page.heading("Beside the paper's Table I");
  page.paragraph(kPaperNote);
  page.paragraph(
      "In the paper's table the DCNN is the fastest network at one sample a call alone: at 5 and "
      "10 FFNN-S is faster, and CF always is.");
}

}  // namespace

Json to_json(const Bench& bench) {
  Json json = {{"threads", 1}, {"source", bench.source}, {"notes", bench.notes}};
  json["rows"] = Json::array();
  for (const BenchRow& row : bench.rows) {
    json["rows"].push_back({{"model", row.model},
                            {"file", row.file},
                            {"length", row.length},
                            {"calls", row.calls},
                            {"mean_s", row.call.mean},
                            {"std_s", row.call.deviation},
                            {"total_s", row.total.mean},
                            {"total_std_s", row.total.deviation},
                            {"p50_s", row.p50},
                            {"p99_s", row.p99},
                            {"max_s", row.maximum},
                            {"per_sample_s", row.per_sample},
                            {"features_included", row.features_included}});
  }
  return json;
}

std::string to_text(const Bench& bench) {
  std::vector<std::vector<std::string>> lines{kHeader};
  for (const BenchRow& row : bench.rows) lines.push_back(cells(row));
  std::vector<std::size_t> widths(kHeader.size(), 0);
  for (const auto& line : lines) {
    for (std::size_t k = 0; k < line.size(); ++k) {
      widths[k] = std::max(widths[k], static_cast<std::size_t>(character_count(line[k])));
    }
  }
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t k = 0; k + 1 < line.size(); ++k) text += padded(line[k], widths[k] + 2);
    text += line.back() + "\n";
  }
  return text + kPaperNote + "\n";
}

std::string to_html(const Bench& bench, const BenchRequest& request, const Peers* peers) {
  HtmlReport page("Tool dynamics identification: computation time");
  if (!bench.rows.empty()) add_calls(page, bench, request);
  for (const auto& note : bench.notes) page.paragraph(note);
  if (peers) add_to(page, *peers);
  return page.html();
}

}  // namespace dcnn
