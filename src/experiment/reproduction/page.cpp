// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/page.h"

#include <algorithm>

#include "experiment/markup.h"
#include "experiment/reproduction/assumptions.h"
#include "experiment/reproduction/figures.h"
#include "experiment/reproduction/page_tables.h"

namespace dcnn {
namespace {

using Group = Entry::Group;

/// The entries of some groups, and those named beside them for comparison.
std::vector<Entry> pick(const std::vector<Entry>& entries, const std::vector<Group>& groups,
                        const std::vector<std::string>& names) {
  std::vector<Entry> chosen;
  for (const Entry& entry : entries) {
    const bool in = std::find(groups.begin(), groups.end(), entry.group) != groups.end() ||
                    std::find(names.begin(), names.end(), entry.name) != names.end();
    if (in) chosen.push_back(entry);
  }
  return chosen;
}

Chart wide(Chart chart, const std::string& title) {
  chart.title = title;
  chart.width = 880;
  return chart;
}

/// The headline figure under one protocol.
void add_figure_5(HtmlReport& page, const ReproductionPlan& plan, const Scores& scores,
                  const std::string& series, const std::string& words) {
  const auto entries = pick(plan.entries, {Group::kPaper}, {"lstm-25"});
  page.panels(error_panels(scores, entries),
              "Fig. 5, " + series + " (" + words +
                  "): RMSE, mean over draws of the test noise; "
                  "bars are ±1 standard deviation over draws (below the size of a marker where not "
                  "seen). " +
                  std::to_string(scores.samples) +
                  " test samples, the same noisy inputs "
                  "for all models. Logarithmic axis.");
}

void add_noise_experiment(HtmlReport& page, const ReproductionRequest& request,
                          const ReproductionPlan& plan, const Results& results) {
  page.heading("Noise experiment (Fig. 5)");
  for (const Protocol& protocol : plan.protocols) {
    add_figure_5(page, plan, results.scores.at("feature/" + protocol.name),
                 "protocol " + protocol.name, protocol.words);
  }
  const Scores &a = results.scores.at("feature/A"), &b = results.scores.at("feature/B");
  const auto mixed = error_panels(only_one_augmented(a, b, request.augment_only),
                                  pick(plan.entries, {Group::kPaper}, {}));
  if (!mixed.empty()) {
    page.chart(wide(mixed.back(), "overall"), "The third reading: only " +
                                                  label_of(plan.entries, request.augment_only) +
                                                  " was trained with noise.");
  }
  for (const Protocol& protocol : plan.protocols) {
    page.paragraph("Protocol " + protocol.name + ", " + protocol.words +
                   ": mean ± standard deviation over draws.");
    add_score_table(page, results.scores.at("feature/" + protocol.name), plan.entries);
  }
}

void add_other_entries(HtmlReport& page, const ReproductionPlan& plan, const Results& results) {
  const Scores& scores = results.scores.at("feature/A");
  const auto readings = pick(plan.entries, {Group::kReading}, {"ffnn-s", "cfnn-m", "lstm", "dcnn"});
  const auto own = pick(plan.entries, {Group::kOwn}, {"cf", "dcnn"});
  if (readings.size() > 4) {
    page.heading("Other readings of the same models");
    page.chart(
        wide(error_panels(scores, readings).back(), "overall, protocol A"),
        "Beside the main readings: 'valid' padding, the angles alone as inputs of the shallow "
        "networks, and windows of 25 samples where LSTM-25 is among the models.");
  }
  if (own.size() > 2) {
    page.heading("This toolkit's own identifiers");
    page.chart(wide(error_panels(scores, own).back(), "overall, protocol A"),
               "Not in the paper. CF and DCNN for comparison.");
  }
}

void add_other_modes(HtmlReport& page, const ReproductionPlan& plan, const Results& results) {
  if (plan.modes.size() < 2) return;
  page.heading("What 'noise' may mean");
  page.paragraph(
      "The paper does not say where its noise is added. Overall RMSE, protocol A, under other "
      "readings; the models were trained with noise per feature.");
  std::vector<Chart> charts;
  for (const NoiseMode& mode : plan.modes) {
    if (mode.name == "feature") continue;
    const Scores& scores = results.scores.at(mode.name + "/A");
    charts.push_back(
        error_panels(scores, pick(plan.entries, {Group::kPaper}, {"dcnn-t", "frame-tcn"})).back());
    charts.back().title = mode.name;
    page.paragraph(mode.name + ": " + mode.words + "; " + std::to_string(mode.draws) + " draws, " +
                   std::to_string(scores.samples) + " samples.");
  }
  page.panels(charts, "Overall RMSE under each noise mode, ±1 standard deviation over draws.");
}

void add_curves(HtmlReport& page, const ReproductionRequest& request, const ReproductionPlan& plan,
                const Results& results) {
  const OutputLayout layout{request.out};
  page.heading("Training");
  page.paragraph(
      "The loss is of what each network learns from, with noise and dropout, and not comparable "
      "between networks; validation is the last part of the training recording. For networks "
      "trained by Levenberg-Marquardt an epoch is an iteration.");
  for (const Protocol& protocol : plan.protocols) {
    page.panels(training_panels(layout, protocol.name, pick(plan.entries, {Group::kPaper}, {})),
                "The paper's networks, protocol " + protocol.name + ".");
    page.panels(training_panels(layout, protocol.name,
                                pick(plan.entries, {Group::kReading, Group::kOwn}, {})),
                "Other readings and this toolkit's own networks, protocol " + protocol.name + ".");
  }
  const Scores& scores = results.scores.at("feature/A");
  page.heading("Predicted and measured force");
  for (const Chart& chart : trace_panels(results, scores, plan.entries)) page.chart(chart, "");
  page.paragraph("20 s from the middle of the test recording, input without added noise.");
  page.heading("Residuals");
  page.panels(residual_panels(results, scores, plan.entries),
              "How measured - predicted is spread over the test recording, input without added "
              "noise.");
}

/// The model of least overall error, noise being absent, beside no identification.
std::string best_model(const Scores& scores, const std::vector<Entry>& entries) {
  const ModelScores* best = nullptr;
  for (const ModelScores& model : scores.models) {
    if (!model.levels.front().overall) return "";
    if (!best || model.levels.front().overall->mean < best->levels.front().overall->mean)
      best = &model;
  }
  const ModelScores* none = scores.find("ns");
  return best ? label_of(entries, best->entry) + " predicts the test recording best (RMSE " +
                    significant(best->levels.front().overall->mean, 3) + " " + scores.units[0] +
                    (none ? ", without identification " +
                                significant(none->levels.front().overall->mean, 3) + " " +
                                scores.units[0]
                          : "") +
                    ")"
              : "";
}

/// Networks of a few epochs say nothing about the paper.
bool judges_claims(const ReproductionRequest& request) { return request.preset != "quick"; }

/// How many of the claims that could be judged hold, all models being trained with noise.
std::string reproduction_answer(const ReproductionRequest& request, const ReproductionPlan& plan,
                                const Scores& scores, const Verdicts& verdicts) {
  if (!judges_claims(request)) {
    const std::string best = best_model(scores, plan.entries);
    return "A first look with networks of a few epochs" + (best.empty() ? "." : ": " + best + ".") +
           " It does not judge the paper's claims: tools/reproduce --preset standard, or fair, "
           "does.";
  }
  int judged = 0, hold = 0;
  for (const Claim& claim : verdicts.claims) {
    judged += claim.verdict != Claim::Verdict::kNotTested;
    hold += claim.verdict == Claim::Verdict::kHolds;
  }
  return "Of the paper's claims " + std::to_string(judged) + " could be tested and " +
         std::to_string(hold) + " hold here (preset " + request.preset + ").";
}

void add_assumptions(HtmlReport& page) {
  page.heading("What the paper leaves open, and what was assumed");
  std::vector<std::vector<std::string>> rows;
  for (const Assumption& a : assumptions()) rows.push_back({a.id, a.open, a.decided, a.evidence});
  page.table({"", "open", "decided", "evidence"}, rows);
}

}  // namespace

std::string reproduction_page(const ReproductionRequest& request, const ReproductionPlan& plan,
                              const Results& results, const std::vector<Verdicts>& verdicts,
                              const Conditions& provenance) {
  HtmlReport page("Su et al. 2020, reproduced: noise, time and claims");
  Scores first = results.scores.at("feature/A");
  const auto shown = pick(plan.entries, {Group::kPaper}, {"ns"});
  page.paragraph(reproduction_answer(request, plan, first, verdicts.front()));
  const auto overall = error_panels(first, pick(plan.entries, {Group::kPaper}, {}));
  if (!overall.empty()) {
    page.chart(
        wide(overall.back(), "Error over noise on the input"),
        "RMSE of the paper's identifiers over the noise on their inputs, all trained with noise "
        "(Fig. 5). Logarithmic axis. NS is no identification, which predicts zero; CF is curve "
        "fitting, the force as a function of the orientation.");
  }
  std::erase_if(first.models, [&](const ModelScores& model) {
    return std::none_of(shown.begin(), shown.end(),
                        [&](const Entry& e) { return e.name == model.entry; });
  });
  add_overall_table(page, first, plan.entries);
  page.paragraph(
      "H. Su et al., \"Deep Neural Network Approach in Robot Tool Dynamics Identification for "
      "Bilateral Teleoperation\", IEEE RA-L 2020. The authors' data are not public and their Fig. "
      "5 has no printed numbers: what can be tested are the claims and the structure of Table I. "
      "Preset " +
      request.preset + ", " +
      (request.data.empty() ? "simulated recordings." : "recordings given by the user."));
  page.heading("Claims");
  page.paragraph(
      "By which models were trained with noise on their inputs: all, none, or one alone.");
  if (!judges_claims(request)) {
    page.paragraph(
        "Preset quick trains for a few epochs: its numbers are no verdict on the paper.");
  }
  add_claim_table(page, verdicts, judges_claims(request));
  add_noise_experiment(page, request, plan, results);
  add_other_entries(page, plan, results);
  add_other_modes(page, plan, results);
  if (plan.trainings > 0) {
    page.heading("Spread over trainings");
    add_training_spread(page, plan, results);
  }
  page.heading("Computation time (Table I)");
  add_timing_table(page, results.timings, plan);
  add_curves(page, request, plan, results);
  add_assumptions(page);
  page.heading("Where these numbers come from");
  page.table({"of", "value"}, provenance.rows);
  return page.html();
}

}  // namespace dcnn
