// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/reproduce.h"

#include <chrono>

#include "dcnn/cells/merge.h"
#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "experiment/reproduction/pace.h"
#include "experiment/reproduction/page.h"
#include "experiment/reproduction/stages.h"
#include "experiment/reproduction/tables.h"

namespace dcnn {
namespace {

constexpr std::size_t kMaxDataBytes = std::size_t{4} << 30;
const std::string kRecipePlace = "data/import.json";  // below the output folder

std::vector<Verdicts> judge(const ReproductionRequest& request, const Results& results) {
  const Scores &a = results.scores.at("feature/A"), &b = results.scores.at("feature/B");
  return {{"A: all", judge_claims(a, results.timings)},
          {"B: none", judge_claims(b, results.timings)},
          {"only " + request.augment_only,
           judge_claims(only_one_augmented(a, b, request.augment_only), results.timings)}};
}

std::string recording_words(const ReproductionRequest& request, RecordingPart part) {
  const std::filesystem::path place = recording_place(request, part);
  const auto& given = request.data;
  const auto name = given.empty() ? place : given.at(part == RecordingPart::kTraining ? 0 : 1);
  return name.filename().string() + ", SHA-256 " + FileDigests().of(request.out / place);
}

Conditions provenance(const ReproductionRequest& request, const ReproductionPlan& plan,
                      const Results& results) {
  const OutputLayout layout{request.out};
  Conditions p;
  p.rows = {{"preset", request.preset},
            {"training recording", recording_words(request, RecordingPart::kTraining)},
            {"test recording", recording_words(request, RecordingPart::kTest)},
            {"seed of training and of test noise", std::to_string(request.seed)},
            {"draws per level", std::to_string(plan.modes.front().draws)},
            {"test samples scored", std::to_string(results.scores.at("feature/A").samples)},
            {"threads of a training", "1"},
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

/// Inputs of cells lie below their root.
void keep_recordings(const ReproductionRequest& request) {
  const auto keep = [&](const std::filesystem::path& file, const std::string& place) {
    write_file(request.out / place, read_file(file, kMaxDataBytes, Exit::kData));
  };
  for (const RecordingPart part : {RecordingPart::kTraining, RecordingPart::kTest}) {
    if (!request.data.empty())
      keep(request.data.at(part == RecordingPart::kTraining ? 0 : 1),
           recording_place(request, part));
  }
  if (request.recipe) keep(*request.recipe, kRecipePlace);
}

/// As the tool that failed would have ended.
void require_all_done(const std::filesystem::path& folder) {
  const Json failed = cells_status(folder)["failed"];
  if (failed.empty()) return;
  const Json& cell = failed.front();
  std::string words = cell["log"].get<std::string>();
  words.erase(words.find_last_not_of('\n') + 1);
  const int code = cell["exit"];
  const bool ours = code == static_cast<int>(Exit::kUsage) ||
                    code == static_cast<int>(Exit::kData) || code == static_cast<int>(Exit::kModel);
  fail(ours ? static_cast<Exit>(code) : Exit::kFailure, cell["name"].get<std::string>(), ": exit ",
       code, ": ", words.substr(words.find_last_of('\n') + 1));
}

/// Runs what is not finished of a stage and lays its files where the next one finds them. False
/// where it was stopped, or planned alone.
bool finish_stage(const ReproductionStage& stage, const ReproductionRequest& request,
                  const CellRunObserver& observer, ReproductionOutcome& outcome) {
  const auto folder = OutputLayout{request.out}.cells(stage.name);
  write_plan(make_plan({{"cells", stage.cells}}, stage.name, request.out, request.programs), folder,
             true);
  if (request.prepare && cells_status(folder)["left"] != 0) {
    outcome.prepared = folder;
    return false;
  }
  CellRun run;
  run.folder = run.scratch = folder;
  run.jobs = stage.one_at_a_time ? 1 : request.jobs;
  run.again = true;
  run.weight = [&](const Cell& cell) { return stage.seconds.at(cell.name); };
  run.programs = request.programs;
  const CellRunOutcome ran = run_cells(run, observer);
  outcome.done += ran.done;
  outcome.skipped += ran.skipped;
  if (!ran.finished) return false;
  require_all_done(folder);
  unpack_cells(folder, request.out, true);
  return true;
}

double seconds_of(const ReproductionStage& stage) {
  double sum = 0.0;
  for (const auto& [name, seconds] : stage.seconds) sum += seconds;
  return sum;
}

/// False where it was stopped, or prepared.
bool finish_stages(const std::vector<ReproductionStage>& stages, const ReproductionRequest& request,
                   const CellRunObserver& observer, ReproductionOutcome& outcome) {
  std::vector<double> planned;
  for (const ReproductionStage& stage : stages) planned.push_back(seconds_of(stage));
  Pace pace(planned);
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const ReproductionStage& stage = stages[k];
    CellRunObserver part = observer;
    part.progress = [&](double done, const std::string& text) {
      const std::chrono::duration<double> run = std::chrono::steady_clock::now() - start;
      observer.progress(pace.share(k, done, run.count()), stage.name + ": " + text);
    };
    if (!finish_stage(stage, request, part, outcome)) return false;
    if (stage.name != "recordings") continue;
    for (const RecordingPart recording : {RecordingPart::kTraining, RecordingPart::kTest}) {
      require(std::filesystem::exists(request.out / recording_place(request, recording)),
              Exit::kUsage, request.scene.string(),
              ": must simulate recordings named 'train' and 'test'");
    }
  }
  return true;
}

}  // namespace

Json reproduction_plan(const ReproductionRequest& request) {
  const ReproductionPlan plan = make_plan(request);
  check_request(request, plan);
  Json list = Json::array();
  double total = 0;
  for (const ReproductionStage& stage : reproduction_stages(request, plan)) {
    for (const Json& cell : stage.cells) {
      const auto name = cell["name"].get<std::string>();
      list.push_back({{"step", name}, {"seconds", stage.seconds.at(name)}});
    }
    total += seconds_of(stage);
  }
  return {{"steps", list}, {"seconds", total}};
}

ReproductionOutcome reproduce(const ReproductionRequest& given, const CellRunObserver& observer) {
  ReproductionRequest request = given;
  if (request.recipe) {
    request.read.insert(request.read.end(), {"--recipe", "in/" + kRecipePlace});
  }
  const ReproductionPlan plan = make_plan(request);
  check_request(request, plan);
  const std::vector<ReproductionStage> stages = reproduction_stages(request, plan);
  keep_recordings(request);
  ReproductionOutcome outcome;
  outcome.finished = finish_stages(stages, request, observer, outcome);
  if (!outcome.finished) return outcome;

  const OutputLayout layout{request.out};
  const Results results = read_results(layout, plan);
  FileSet files(layout.out);
  write_tables(layout, plan, results);
  const auto verdicts = judge(request, results);
  const auto from = provenance(request, plan, results);
  outcome.summary = summary_of(request, verdicts, from);
  outcome.report = layout.report();
  write_file(layout.out / "reproduction.json", outcome.summary.dump(2) + "\n");
  write_file(layout.report(), reproduction_page(request, plan, results, verdicts, from));
  files.commit();
  return outcome;
}

}  // namespace dcnn
