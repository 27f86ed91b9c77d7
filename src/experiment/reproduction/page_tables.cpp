// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/page_tables.h"

#include "experiment/levels.h"
#include "experiment/markup.h"
#include "experiment/reproduction/figures.h"
#include "experiment/reproduction/paper_times.h"

namespace dcnn {
namespace {

using Cells = std::vector<std::string>;

std::string level_with_spread(const Spread& s, int runs) {
  if (runs < 2) return fixed(s.mean, 4);
  return fixed(s.mean, 4) + " ± " + fixed(s.deviation, 4);
}

/// Networks of a few epochs neither confirm a claim nor refute it.
std::string mark(Claim::Verdict verdict, bool judged) {
  if (!judged && verdict != Claim::Verdict::kNotTested) return "– not judged";
  switch (verdict) {
    case Claim::Verdict::kHolds:
      return "✓ true";
    case Claim::Verdict::kFails:
      return "✗ false";
    case Claim::Verdict::kNotTested:
      return "– not tested";
  }
  return {};
}

/// One row a model, one column a level; `value` gives the number.
template <class Value>
void add_level_table(HtmlReport& page, const Scores& scores, const std::vector<Entry>& entries,
                     const std::string& name, Value value) {
  Cells header{name};
  for (const LevelScore& level : scores.models.front().levels)
    header.push_back(level_name(level.snr_db));
  std::vector<Cells> rows;
  for (const ModelScores& model : scores.models) {
    Cells row{label_of(entries, model.entry)};
    for (const LevelScore& level : model.levels) row.push_back(value(level));
    rows.push_back(row);
  }
  page.table(header, rows);
}

}  // namespace

void add_claim_table(HtmlReport& page, const std::vector<Verdicts>& verdicts, bool judged) {
  Cells header{"", "claim"};
  for (const Verdicts& v : verdicts) header.push_back(v.series);
  std::vector<Cells> rows;
  const auto& first = verdicts.front().claims;
  for (std::size_t k = 0; k < first.size(); ++k) {
    Cells row{first[k].id, first[k].text};
    for (const Verdicts& v : verdicts) row.push_back(mark(v.claims[k].verdict, judged));
    rows.push_back(row);
  }
  page.table(header, rows);
  std::vector<Cells> numbers;
  for (std::size_t k = 0; k < first.size(); ++k) {
    for (const Verdicts& v : verdicts) {
      const Claim& claim = v.claims[k];
      if (claim.verdict == Claim::Verdict::kNotTested) continue;
      if (claim.id == "C5" && &v != &verdicts.front()) continue;  // times have no protocol
      numbers.push_back({claim.id, claim.id == "C5" ? "" : v.series, claim.numbers});
    }
  }
  if (numbers.empty()) return;
  page.paragraph("What the verdicts rest on, as means over the noisy levels:");
  page.table({"", "reading", "numbers"}, numbers);
}

void add_overall_table(HtmlReport& page, const Scores& scores, const std::vector<Entry>& entries) {
  if (!scores.models.front().levels.front().overall) return;
  add_level_table(
      page, scores, entries, "overall [" + scores.units[0] + "]",
      [](const LevelScore& level) { return level_with_spread(*level.overall, level.runs); });
}

void add_score_table(HtmlReport& page, const Scores& scores, const std::vector<Entry>& entries) {
  add_overall_table(page, scores, entries);
  for (std::size_t j = 0; j < scores.targets.size(); ++j) {
    add_level_table(
        page, scores, entries, scores.targets[j] + " [" + scores.units[j] + "]",
        [j](const LevelScore& level) { return level_with_spread(level.rmse[j], level.runs); });
  }
}

namespace {

/// One repetition has no standard deviation.
std::string repeated(double mean, double deviation) {
  return significant(mean, 4) + (deviation > 0 ? " ± " + significant(deviation, 2) : "");
}

/// Mean time of the same call from the raw pose, "–" where it was not measured.
std::string time_from_pose(const std::vector<Timing>& timings, const Timing& same) {
  for (const Timing& t : timings) {
    if (t.from_pose && t.entry == same.entry && t.length == same.length)
      return significant(t.mean_s * 1e6, 4);
  }
  return "–";
}

}  // namespace

void add_timing_table(HtmlReport& page, const std::vector<Timing>& timings,
                      const ReproductionPlan& plan) {
  if (timings.empty()) return page.paragraph("Not measured.");
  page.chart(timing_chart(timings, plan.entries),
             "Mean time per call, ±1 standard deviation over repetitions.");
  std::vector<Cells> rows, details;
  for (const Timing& t : timings) {
    if (t.from_pose) continue;
    const Cells call{label_of(plan.entries, t.entry), std::to_string(t.length)};
    const PaperTime* paper = paper_time(t.entry, t.length);
    rows.push_back(call);
    for (const auto& cell :
         {std::to_string(t.calls), repeated(t.mean_s * 1e6, t.std_s * 1e6),
          repeated(t.total_s, t.total_std_s), paper ? significant(paper->mean_s * 1e6, 5) : "–",
          paper ? fixed(paper->total_s, 2) : "–"})
      rows.back().push_back(cell);
    details.push_back(call);
    for (const double seconds : {t.mean_s / t.length, t.p50_s, t.p99_s, t.max_s})
      details.back().push_back(significant(seconds * 1e6, 3));
    details.back().push_back(time_from_pose(timings, t));
  }
  page.table({"model", "L", "calls", "mean [µs]", "total [s]", "paper [µs]", "paper total [s]"},
             rows);
  page.table(
      {"model", "L", "per sample [µs]", "p50 [µs]", "p99 [µs]", "max [µs]", "from pose [µs]"},
      details);
  page.paragraph(
      "L samples per call, one pinned thread, from the 15 features to the force; 'from pose': mean "
      "with the features made in the call, by the causal derivative filter. Repetitions: " +
      std::to_string(plan.timing.repetitions) +
      (plan.timing.repetitions_lstm_25 != plan.timing.repetitions
           ? ", for LSTM-25 " + std::to_string(plan.timing.repetitions_lstm_25)
           : "") +
      ". The paper's absolute values (MATLAB 2018b, i7 2.80 GHz) are no benchmark: there the "
      "overhead of a call dominates, so that its networks cost nearly the same for 1, 5 and 10 "
      "samples. The paper's \"0.0006 s\" for batches is a time per sample. In its own table the "
      "DCNN is the fastest network for one sample a call only: FFNN-S is faster for 5 and 10.");
}

void add_training_spread(HtmlReport& page, const ReproductionPlan& plan, const Results& results) {
  std::vector<Cells> rows;
  const Scores& first = results.scores.at(kFurtherTrainings + "/" + further_training(1));
  Cells header{"overall"};
  for (const LevelScore& level : first.models.front().levels)
    header.push_back(level_name(level.snr_db));
  for (std::size_t m = 1; m < first.models.size(); ++m) {
    Cells row{label_of(plan.entries, first.models[m].entry)};
    for (std::size_t l = 0; l < first.models[m].levels.size(); ++l) {
      std::vector<double> values;
      for (int k = 1; k <= plan.trainings; ++k) {
        const auto& level =
            results.scores.at(kFurtherTrainings + "/" + further_training(k)).models[m].levels[l];
        if (level.overall) values.push_back(level.overall->mean);
      }
      row.push_back(level_with_spread(spread(values), static_cast<int>(values.size())));
    }
    rows.push_back(row);
  }
  page.table(header, rows);
  page.paragraph("Mean ± standard deviation over " + std::to_string(plan.trainings) +
                 " trainings with seeds of their own and a third of the epochs, protocol A, one "
                 "draw of test noise each, every 4th test sample.");
}

}  // namespace dcnn
