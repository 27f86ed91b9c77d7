// SPDX-License-Identifier: Apache-2.0
// An evaluation as a page people look at.
#include <algorithm>
#include <cstdio>
#include <set>

#include "dcnn/core/file.h"
#include "dcnn/core/number.h"
#include "dcnn/experiment/evaluate.h"
#include "dcnn/experiment/report.h"
#include "dcnn/experiment/train.h"
#include "experiment/evaluation_table.h"
#include "experiment/levels.h"
#include "experiment/markup.h"
#include "experiment/references.h"
#include "experiment/report_words.h"

namespace dcnn {
namespace {

std::vector<std::string> level_names(const Evaluation& evaluation) {
  std::vector<std::string> names;
  for (const auto& s : evaluation.summary) {
    const auto name = level_name(s.snr_db);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

/// RMSE over the levels: one group of bars a level, one bar a model; `pick` chooses the axis.
template <class Pick>
Chart level_chart(const Evaluation& evaluation, const std::string& title, const std::string& unit,
                  Pick pick) {
  Chart chart;
  chart.title = title;
  chart.x_label = "signal-to-noise ratio of the input";
  chart.y_label = "RMSE [" + unit + "]";
  chart.categories = level_names(evaluation);
  for (const auto& s : evaluation.summary) {
    if (chart.series.empty() || chart.series.back().label != s.file) {
      chart.series.push_back({s.file, {}, {}, {}, Series::Style::kBars});
    }
    const Spread value = pick(s);
    const auto at =
        std::find(chart.categories.begin(), chart.categories.end(), level_name(s.snr_db));
    chart.series.back().x.push_back(static_cast<double>(at - chart.categories.begin()));
    chart.series.back().y.push_back(value.mean);
    chart.series.back().error.push_back(value.deviation);
  }
  return chart;
}

/// The first model's error in one sentence, beside the references.
std::string answer(const Evaluation& evaluation) {
  const EvaluationSummary& s = evaluation.summary.front();
  const std::string unit = unit_text(evaluation.targets.units.front());
  if (!s.overall) return s.file + " on " + std::to_string(evaluation.samples) + " samples.";
  std::string text = s.file + " predicts " + evaluation.data.front() + " with an RMSE of " +
                     significant(s.overall->mean, 3) + " " + unit + " (" + level_name(s.snr_db) +
                     ")";
  if (evaluation.unidentified.overall) {
    text += "; without identification it is " + significant(*evaluation.unidentified.overall, 3) +
            " " + unit;
  }
  if (const Score* rigid = rigid_of(s, evaluation); rigid && rigid->overall) {
    text += ", with the rigid tool " + significant(*rigid->overall, 3) + " " + unit;
  }
  return text + ".";
}

void add_table(HtmlReport& page, const Evaluation& evaluation) {
  std::vector<std::string> header{"model", "SNR", "runs"};
  for (std::size_t j = 0; j < evaluation.targets.names.size(); ++j) {
    header.push_back(evaluation.targets.names[j] + " [" + unit_text(evaluation.targets.units[j]) +
                     "]");
  }
  const std::string unit = unit_text(evaluation.targets.units.front());
  const auto forces = static_cast<std::ptrdiff_t>(std::count(evaluation.targets.units.begin(),
                                                             evaluation.targets.units.end(),
                                                             evaluation.targets.units.front()));
  header.insert(header.end(),
                {"overall [" + unit + "]", "largest error [" + unit + "]", "least R²"});
  const std::vector<int> decimals = column_decimals(evaluation);
  std::vector<std::vector<std::string>> rows;
  for (const auto& s : evaluation.summary) {
    std::vector<std::string> row{s.file, level_name(s.snr_db), std::to_string(s.runs)};
    for (std::size_t j = 0; j < s.rmse.size(); ++j)
      row.push_back(with_spread(s.rmse[j], s.runs, decimals[j]));
    row.push_back(s.overall ? with_spread(*s.overall, s.runs, decimals.back()) : "–");
    char text[64];
    std::snprintf(text, sizeof text, "%.3f",
                  *std::max_element(s.first.max_abs.begin(), s.first.max_abs.begin() + forces));
    row.emplace_back(text);
    std::snprintf(text, sizeof text, "%.4f",
                  *std::min_element(s.first.r2.begin(), s.first.r2.end()));
    row.emplace_back(text);
    rows.push_back(row);
  }
  const auto reference = [&](const std::string& name, const std::vector<double>& rmse,
                             const std::optional<double>& overall) {
    std::vector<std::string> row{name, "clean", "–"};
    for (std::size_t j = 0; j < rmse.size(); ++j) row.push_back(fixed(rmse[j], decimals[j]));
    row.push_back(overall ? fixed(*overall, decimals.back()) : "–");
    row.insert(row.end(), {"–", "–"});
    rows.push_back(row);
  };
  const auto& beside = evaluation.references;
  for (const ShownRigid& rigid : shown_rigid_tools(evaluation)) {
    reference(rigid.name, rigid.score.rmse, rigid.score.overall);
  }
  reference("no identification", evaluation.unidentified.rmse, evaluation.unidentified.overall);
  reference("white noise of the sensor", beside.noise, std::nullopt);
  page.table(header, rows);
  page.paragraph(
      "RMSE: root mean square of measured - predicted, mean ± standard deviation over draws of the "
      "noise on the input, whose power relative to the signal is the SNR (clean: none added). "
      "Overall: the mean over the targets in " +
      unit +
      ". Largest error: over these targets; "
      "R²: 1 - squared error / variance of the target, the least over all targets; both of the "
      "first draw. A rigid tool was fitted to the training rows of its model, with the model's "
      "derivative; no model can be better than the white noise of the sensor.");
}

std::vector<double> values(const Eigen::VectorXd& v) { return {v.data(), v.data() + v.size()}; }

/// A target as measured and as every model predicts it.
Chart trace_chart(const Evaluation& evaluation, std::size_t j) {
  const auto column = static_cast<Eigen::Index>(j);
  const Trace& first = evaluation.traces.front();
  Chart chart;
  chart.title = evaluation.targets.names[j];
  chart.x_label = "time [s]";
  chart.y_label = evaluation.targets.names[j] + " [" + unit_text(evaluation.targets.units[j]) + "]";
  chart.series.push_back({"measured", values(first.t), values(first.measured.col(column)), {}});
  for (const Trace& trace : evaluation.traces) {
    chart.series.push_back({trace.model, values(trace.t), values(trace.predicted.col(column)), {}});
  }
  return chart;
}

bool has_levels(const Evaluation& evaluation) {
  return evaluation.summary.front().overall && level_names(evaluation).size() > 1;
}

/// One picture beside the answer: the error over noise, or where no noise was asked for a trace.
void add_picture(HtmlReport& page, const Evaluation& evaluation) {
  if (has_levels(evaluation)) {
    page.chart(level_chart(evaluation, "Error over noise on the input", evaluation.targets.units[0],
                           [](const EvaluationSummary& s) { return *s.overall; }),
               "Mean of the RMSEs per axis (Eq. 6); bars: mean, whiskers: one standard deviation "
               "over draws.");
  } else if (!evaluation.traces.empty()) {
    page.chart(trace_chart(evaluation, 0), evaluation.data.front() + ", input without added noise");
  }
}

/// Targets of one unit beside one another; nothing where only one level of noise was asked for.
void add_levels(HtmlReport& page, const Evaluation& evaluation) {
  if (level_names(evaluation).size() < 2) return;
  const auto& targets = evaluation.targets;
  page.heading("Error of each target against input noise");
  for (const std::string& unit :
       std::set<std::string>(targets.units.begin(), targets.units.end())) {
    std::vector<Chart> panels;
    for (std::size_t j = 0; j < targets.names.size(); ++j) {
      if (targets.units[j] != unit) continue;
      panels.push_back(level_chart(evaluation, targets.names[j], unit,
                                   [j](const EvaluationSummary& s) { return s.rmse[j]; }));
      panels.back().width = 440;
    }
    page.panels(panels, "Bars: mean over draws of the noise; whiskers: one standard deviation.");
  }
}

void add_traces(HtmlReport& page, const Evaluation& evaluation) {
  if (evaluation.traces.empty()) return;
  const std::size_t begin = has_levels(evaluation) ? 0 : 1;  // the picture is that of the first
  if (begin < evaluation.targets.names.size())
    page.heading(begin == 0 ? "Prediction over time" : "The other targets over time");
  for (std::size_t j = begin; j < evaluation.targets.names.size(); ++j) {
    page.chart(trace_chart(evaluation, j), evaluation.data.front() + ", input without added noise");
  }
  page.heading("Residuals");
  for (std::size_t j = 0; j < evaluation.targets.names.size(); ++j) {
    std::vector<std::vector<double>> residuals;
    std::vector<std::string> labels;
    for (const Trace& trace : evaluation.traces) {
      const auto column = static_cast<Eigen::Index>(j);
      residuals.push_back(values(trace.measured.col(column) - trace.predicted.col(column)));
      labels.push_back(trace.model);
    }
    page.chart(histogram(evaluation.targets.names[j],
                         "measured - predicted [" + unit_text(evaluation.targets.units[j]) + "]",
                         residuals, labels, 60),
               "how the residual is spread, input without added noise");
  }
}

/// Training loss and validation RMSE by epoch, where the model's run directory is still beside it.
void add_training_curve(HtmlReport& page, const std::filesystem::path& model) {
  const auto path = run_directory(model) / "metrics.jsonl";
  if (!std::filesystem::exists(path)) return;
  Series loss{"training loss", {}, {}, {}, Series::Style::kLineAndMarkers};
  Series validation{
      "validation RMSE (mean over targets)", {}, {}, {}, Series::Style::kLineAndMarkers};
  std::istringstream lines(read_file(path, std::size_t{64} << 20, Exit::kData));
  for (std::string line; std::getline(lines, line);) {
    const Json record = parse_json(line, path.string(), Exit::kData);
    loss.x.push_back(record.value("epoch", 0.0));
    loss.y.push_back(record.value("loss", 0.0));
    const auto rmse = record.value("validation_rmse", std::vector<double>{});
    if (rmse.empty()) continue;
    validation.x.push_back(loss.x.back());
    validation.y.push_back(spread(rmse).mean);
  }
  Chart chart;
  chart.title = "training of " + model.filename().string() + ": loss";
  chart.x_label = "epoch";
  chart.y_label = "loss";
  chart.log_y = true;
  chart.legend = false;
  chart.height = 240;
  chart.series = {loss};
  page.chart(chart,
             "From " + path.filename().string() +
                 "; the loss is of the targets as the network sees them, with noise and dropout.");
  if (validation.x.empty()) return;
  chart.title = "training of " + model.filename().string() + ": validation";
  chart.y_label = "RMSE, mean over targets";
  chart.series = {validation};
  page.chart(chart, "On rows that the network was not trained on, without added noise.");
}

void add_settings(HtmlReport& page, const Evaluation& evaluation,
                  const EvaluationRequest& request) {
  page.heading("What these numbers depend on");
  std::string data;
  for (const auto& name : evaluation.data) data += (data.empty() ? "" : ", ") + name;
  std::vector<std::vector<std::string>> rows{
      {"test recordings", data},
      {"samples", std::to_string(evaluation.samples)},
      {"of them near the Euler singularity", std::to_string(evaluation.singular_samples)},
      {"noise seed", std::to_string(request.seed)},
      {"noise draws per level", std::to_string(request.runs)},
      {"precision", request.precision == Precision::kInt16 ? "int16" : "single"},
      {"noise on", evaluation.noise}};
  for (const auto& path : request.models) {
    const Identifier identifier = read_identifier(path);
    const auto count = identifier.model->parameter_count();
    rows.push_back({path.filename().string(),
                    identifier.configuration.value("preset", "") + " preset, seed " +
                        std::to_string(identifier.seed) + ", " +
                        (count == 0 && identifier.base ? "a simulator"
                                                       : std::to_string(count) + " parameters")});
  }
  page.table({"setting", "value"}, rows);
  for (const auto& note : evaluation.notes) page.paragraph(note);
  for (const auto& path : request.models) {
    page.paragraph(
        "Configuration of " + path.filename().string() +
        ", as dcnn-train --config takes it (sigma_floor is the least deviation that an "
        "input is divided by, as a share of the largest of its unit; drop_factor is what "
        "the learning rate is multiplied by after every drop_period epochs; the derivative sg is a "
        "Savitzky-Golay filter, sg_causal the same without look-ahead):");
    page.preformatted(read_identifier(path).configuration.dump(2));
  }
}

}  // namespace

std::string to_html(const Evaluation& evaluation, const EvaluationRequest& request) {
  HtmlReport page("Tool dynamics identification: evaluation");
  for (const auto& warning : evaluation.references.warnings) page.paragraph(warning);
  page.paragraph(answer(evaluation));
  add_picture(page, evaluation);
  add_table(page, evaluation);
  add_traces(page, evaluation);
  add_levels(page, evaluation);
  if (std::any_of(request.models.begin(), request.models.end(), [](const auto& model) {
        return std::filesystem::exists(run_directory(model) / "metrics.jsonl");
      })) {
    page.heading("Training");
    for (const auto& model : request.models) add_training_curve(page, model);
  }
  add_settings(page, evaluation, request);
  return page.html();
}

}  // namespace dcnn
