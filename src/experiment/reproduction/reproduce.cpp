#include "dcnn/experiment/reproduce.h"

#include "dcnn/core/file.h"
#include "dcnn/core/parallel.h"
#include "dcnn/experiment/train.h"
#include "experiment/reproduction/page.h"
#include "experiment/reproduction/steps.h"
#include "experiment/reproduction/tables.h"

namespace dcnn {
namespace {

std::vector<Verdicts> judge(const ReproductionRequest& request, const Results& results) {
  const Scores &a = results.scores.at("feature/A"), &b = results.scores.at("feature/B");
  return {{"A: all", judge_claims(a, results.timings)},
          {"B: none", judge_claims(b, results.timings)},
          {"only " + request.augment_only,
           judge_claims(only_one_augmented(a, b, request.augment_only), results.timings)}};
}

Conditions provenance(const ReproductionRequest& request, const ReproductionPlan& plan,
                      Workshop& workshop, const Results& results, int threads_used) {
  const OutputLayout layout{request.out};
  Conditions p;
  p.rows = {{"preset", request.preset},
            {"training recording", workshop.training_data().filename().string() + ", SHA-256 " +
                                       workshop.data_hash(workshop.training_data())},
            {"test recording", workshop.test_data().filename().string() + ", SHA-256 " +
                                   workshop.data_hash(workshop.test_data())},
            {"seed of training and of test noise", std::to_string(request.seed)},
            {"draws per level", std::to_string(plan.modes.front().draws)},
            {"test samples scored", std::to_string(results.scores.at("feature/A").samples)},
            {"threads", std::to_string(threads_used)},
            {"version", DCNN_VERSION},
            {"commit", request.commit}};
  for (const Entry& entry : plan.entries) {
    if (entry.name == kNoIdentification) continue;
    const Identifier identifier = read_identifier(layout.model("A", entry.name));
    p.rows.push_back(
        {entry.label, std::to_string(identifier.model->parameter_count()) + " parameters; model " +
                          identifier.configuration.value("model", Json()).dump() + "; training " +
                          identifier.configuration.value("training", Json()).dump()});
  }
  return p;
}

Json summary_of(const ReproductionRequest& request, const std::vector<Verdicts>& verdicts,
                const Conditions& from) {
  Json summary = {{"preset", request.preset}, {"seed", request.seed}, {"commit", request.commit}};
  for (const Verdicts& v : verdicts) summary["claims"][v.series] = to_json(v.claims);
  for (const auto& row : from.rows) summary["depends_on"][row[0]] = row[1];
  summary["report"] = OutputLayout{request.out}.report().string();
  return summary;
}

void check_request(const ReproductionRequest& request, const ReproductionPlan& plan) {
  require(request.data.empty() || request.data.size() == 2, Exit::kUsage,
          "--data: give a training and a test recording");
  require(plan.entries.size() > 1, Exit::kUsage, "--models: nothing to train");
  const auto& entries = plan.entries;
  require(request.models.empty() ||
              std::any_of(entries.begin(), entries.end(),
                          [&](const Entry& e) { return e.name == request.augment_only; }) ||
              request.augment_only == "dcnn",
          Exit::kUsage, "--augment-only: '", request.augment_only, "' is not among the models");
}

}  // namespace

Json reproduction_plan(const ReproductionRequest& request) {
  const ReproductionPlan plan = make_plan(request);
  check_request(request, plan);
  Workshop workshop(request, plan);
  Json list = Json::array();
  double total = 0;
  for (const Step& step : workshop.steps()) {
    list.push_back({{"step", step.name}, {"seconds", step.seconds}});
    total += step.seconds;
  }
  return {{"steps", list}, {"seconds", total}};
}

ReproductionOutcome reproduce(const ReproductionRequest& request,
                              const ReproductionObserver& observer) {
  const ReproductionPlan plan = make_plan(request);
  check_request(request, plan);
  const OutputLayout layout{request.out};
  Workshop workshop(request, plan);
  ReproductionOutcome outcome;
  const int threads_used = threads();
  outcome.finished = run_steps(workshop.steps(), layout.stamps(), observer, outcome);
  if (!outcome.finished) return outcome;

  const Results results = read_results(layout, plan);
  write_tables(layout, plan, results);
  const auto verdicts = judge(request, results);
  const auto from = provenance(request, plan, workshop, results, threads_used);
  outcome.summary = summary_of(request, verdicts, from);
  outcome.report = layout.report();
  write_file(layout.out / "reproduction.json", outcome.summary.dump(2) + "\n");
  write_file(layout.report(), reproduction_page(request, plan, results, verdicts, from));
  return outcome;
}

}  // namespace dcnn
