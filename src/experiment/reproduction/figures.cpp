// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/figures.h"

#include <algorithm>
#include <sstream>

#include "dcnn/core/file.h"
#include "dcnn/experiment/train.h"
#include "experiment/levels.h"
#include "experiment/markup.h"
#include "experiment/svg_marks.h"

namespace dcnn {
namespace {

constexpr int kPanelWidth = 440, kPanelHeight = 300;

Chart panel(const std::string& title, const std::string& x_label, const std::string& y_label) {
  return {.title = title,
          .x_label = x_label,
          .y_label = y_label,
          .series = {},
          .categories = {},
          .log_y = false,
          .width = kPanelWidth,
          .height = kPanelHeight};
}

/// From one edge of the plot to the other, so that a constant reads as a limit.
Series constant(const Entry& entry, const std::vector<double>& y) {
  Series series{entry.label, {}, {}, {}, Series::Style::kLine, entry.look};
  series.x = {-0.5, static_cast<double>(y.size()) - 0.5};
  series.y = {y.front(), y.front()};
  return series;
}

/// One panel; `pick` chooses the number of a level, nothing where it has none.
template <class Pick>
Chart error_panel(const Scores& scores, const std::vector<Entry>& entries, Pick pick) {
  Chart chart = panel("", "signal-to-noise ratio of the input", "RMSE [" + scores.units[0] + "]");
  chart.log_y = true;
  chart.side_by_side = true;
  for (const LevelScore& level : scores.models.front().levels)
    chart.categories.push_back(level_name(level.snr_db));
  for (const Entry& entry : entries) {
    const ModelScores* model = scores.find(entry.name);
    if (model == nullptr) continue;
    Series series{entry.label, {}, {}, {}, Series::Style::kMarkers, entry.look};
    for (const LevelScore& level : model->levels) {
      const std::optional<Spread> value = pick(level);
      if (!value) continue;
      series.x.push_back(static_cast<double>(series.x.size()));
      series.y.push_back(value->mean);
      series.error.push_back(value->deviation);
    }
    if (entry.name == kNoIdentification && !series.y.empty()) series = constant(entry, series.y);
    chart.series.push_back(series);
  }
  return chart;
}

/// Column of a trace by name.
std::vector<double> column(const Table& table, const std::string& name) {
  const auto at = std::find(table.columns.begin(), table.columns.end(), name);
  if (at == table.columns.end()) return {};
  const Eigen::VectorXd values = table.values.col(at - table.columns.begin());
  return {values.data(), values.data() + values.size()};
}

/// The models whose curves are drawn: more than a handful cannot be told apart.
std::vector<const Entry*> drawn(const Results& results, const std::vector<Entry>& entries) {
  std::vector<const Entry*> chosen;
  for (const char* name : {"cf", "ffnn-m", "lstm", "dcnn", "dcnn-t"}) {
    for (const Entry& entry : entries) {
      if (entry.name == name && results.traces.contains(name)) chosen.push_back(&entry);
    }
  }
  if (!chosen.empty()) return chosen;
  for (const Entry& entry : entries) {
    if (results.traces.contains(entry.name) && chosen.size() < 5) chosen.push_back(&entry);
  }
  return chosen;
}

/// Rows of a table whose t lies in the 20 s around its middle.
std::vector<std::size_t> middle_rows(const std::vector<double>& t) {
  std::vector<std::size_t> rows;
  if (t.empty()) return rows;
  const double middle = (t.front() + t.back()) / 2;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (std::abs(t[i] - middle) <= 10) rows.push_back(i);
  }
  return rows;
}

Series over_time(const std::string& label, int look, const Table& table, const std::string& name) {
  Series series{label, {}, {}, {}, Series::Style::kLine, look};
  const auto t = column(table, "t"), y = column(table, name);
  for (const std::size_t i : middle_rows(t)) {
    series.x.push_back(t[i]);
    series.y.push_back(y[i]);
  }
  return series;
}

}  // namespace

std::string label_of(const std::vector<Entry>& entries, const std::string& name) {
  for (const Entry& entry : entries) {
    if (entry.name == name) return entry.label;
  }
  return name;
}

std::vector<Chart> error_panels(const Scores& scores, const std::vector<Entry>& entries) {
  std::vector<Chart> charts;
  for (std::size_t j = 0; j < scores.targets.size(); ++j) {
    charts.push_back(error_panel(scores, entries, [j](const LevelScore& level) {
      return std::optional<Spread>(level.rmse[j]);
    }));
    charts.back().title = scores.targets[j];
    charts.back().y_label = "RMSE [" + scores.units[j] + "]";
  }
  if (!scores.models.empty() && scores.models.front().levels.front().overall) {
    charts.push_back(
        error_panel(scores, entries, [](const LevelScore& level) { return level.overall; }));
    charts.back().title = "overall";
  }
  for (std::size_t k = 0; k < charts.size(); ++k) {
    std::string& title = charts[k].title;
    if (title.size() == 2) title[0] = static_cast<char>(std::toupper(title[0]));
    title = "(" + std::string(1, static_cast<char>('a' + k)) + ") " + title;
  }
  return charts;
}

std::vector<Chart> training_panels(const OutputLayout& layout, const std::string& series,
                                   const std::vector<Entry>& entries) {
  Chart loss = panel("training loss", "epoch", "loss, as each network sees its targets"),
        validation = panel("validation", "epoch", "mean RMSE over the targets");
  loss.log_y = validation.log_y = true;
  for (const Entry& entry : entries) {
    const auto path = run_directory(layout.model(series, entry.name)) / "metrics.jsonl";
    if (!std::filesystem::exists(path)) continue;
    Series of_loss{entry.label, {}, {}, {}, Series::Style::kLine, entry.look};
    Series of_validation = of_loss;
    std::istringstream lines(read_file(path, std::size_t{64} << 20, Exit::kData));
    for (std::string line; std::getline(lines, line);) {
      const Json record = parse_json(line, path.string(), Exit::kData);
      of_loss.x.push_back(record.value("epoch", 0.0));
      of_loss.y.push_back(record.value("loss", 0.0));
      const auto rmse = record.value("validation_rmse", std::vector<double>{});
      if (rmse.empty()) continue;
      of_validation.x.push_back(of_loss.x.back());
      of_validation.y.push_back(spread(rmse).mean);
    }
    if (of_loss.x.size() < 2) continue;  // solved in one step
    loss.series.push_back(of_loss);
    validation.series.push_back(of_validation);
  }
  if (loss.series.empty()) return {};
  return {loss, validation};
}

std::vector<Chart> trace_panels(const Results& results, const Scores& scores,
                                const std::vector<Entry>& entries) {
  std::vector<Chart> charts;
  const auto models = drawn(results, entries);
  for (std::size_t j = 0; j < scores.targets.size() && !models.empty(); ++j) {
    const auto& name = scores.targets[j];
    Chart chart = panel("", "t [s]", name + " [" + scores.units[j] + "]");
    chart.width = 2 * kPanelWidth;
    chart.height = 250;
    chart.series.push_back(
        over_time("measured", kPlainBlack, results.traces.at(models[0]->name), name));
    for (const Entry* entry : models) {
      chart.series.push_back(
          over_time(entry->label, entry->look, results.traces.at(entry->name), name + "_hat"));
    }
    charts.push_back(chart);
  }
  return charts;
}

std::vector<Chart> residual_panels(const Results& results, const Scores& scores,
                                   const std::vector<Entry>& entries) {
  std::vector<Chart> charts;
  const auto models = drawn(results, entries);
  for (std::size_t j = 0; j < scores.targets.size() && !models.empty(); ++j) {
    const auto& name = scores.targets[j];
    std::vector<std::vector<double>> residuals;
    std::vector<std::string> labels;
    for (const Entry* entry : models) {
      const Table& trace = results.traces.at(entry->name);
      auto values = column(trace, name);
      const auto predicted = column(trace, name + "_hat");
      for (std::size_t i = 0; i < values.size(); ++i) values[i] -= predicted[i];
      residuals.push_back(values);
      labels.push_back(entry->label);
    }
    Chart chart =
        histogram(name, "measured - predicted [" + scores.units[j] + "]", residuals, labels, 60);
    for (std::size_t k = 0; k < chart.series.size(); ++k) {
      chart.series[k].style = Series::Style::kLine;
      chart.series[k].look = models[k]->look;
    }
    chart.width = kPanelWidth;
    chart.height = kPanelHeight;
    charts.push_back(chart);
  }
  return charts;
}

Chart timing_chart(const std::vector<Timing>& timings, const std::vector<Entry>& entries) {
  Chart chart = panel("time per call", "samples per call", "mean time [µs]");
  chart.width = 2 * kPanelWidth;
  chart.log_y = true;
  chart.side_by_side = true;
  std::vector<int> lengths;
  for (const Timing& t : timings) {
    if (std::find(lengths.begin(), lengths.end(), t.length) == lengths.end())
      lengths.push_back(t.length);
  }
  for (const int length : lengths) chart.categories.push_back(std::to_string(length));
  for (const Entry& entry : entries) {
    Series series{entry.label, {}, {}, {}, Series::Style::kMarkers, entry.look};
    for (const Timing& t : timings) {
      if (t.entry != entry.name || t.from_pose) continue;
      const auto at = std::find(lengths.begin(), lengths.end(), t.length) - lengths.begin();
      series.x.push_back(static_cast<double>(at));
      series.y.push_back(t.mean_s * 1e6);
      series.error.push_back(t.std_s * 1e6);
    }
    if (!series.x.empty()) chart.series.push_back(series);
  }
  return chart;
}

}  // namespace dcnn
