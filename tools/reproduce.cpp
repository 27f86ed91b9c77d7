// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/reproduce.h"

#include <cstdio>
#include <iostream>

#include "dcnn/core/parallel.h"
#include "dcnn/experiment/configuration.h"
#include "support/doctor.h"
#include "support/interrupt.h"
#include "support/progress.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-reproduce --preset quick                       # a first look, minutes\n"
    "  dcnn-reproduce --preset standard --out out/paper    # again after Ctrl-C: goes on\n"
    "  dcnn-reproduce --data train.csv test.csv --models cf dcnn\n"
    "  dcnn-reproduce --preset paper --plan                # cells and expected time\n"
    "  dcnn-reproduce --preset paper --out p --prepare     # cells for dcnn-sweep, elsewhere\n";

std::string minutes(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f min", seconds / 60.0);
  return text;
}

void print_plan(const Json& plan) {
  for (const Json& step : plan["steps"]) {
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%9.1f s  ", step["seconds"].get<double>());
    std::cout << seconds << step["step"].get<std::string>() << "\n";
  }
  std::cout << "sum " << minutes(plan["seconds"].get<double>())
            << " on one core: an estimate from another machine, idle; a run measures its own\n";
}

void print_claims(const Json& summary, const std::string& preset) {
  if (preset == "quick") {
    std::cout << "a first look with networks of a few epochs: the numbers are in the report, the "
                 "paper's claims need\n"
                 "--preset standard or fair\n";
    return;
  }
  for (const auto& [series, claims] : summary["claims"].items()) {
    std::cout << series << "\n";
    for (const Json& claim : claims) {
      const Json& holds = claim["holds"];
      std::cout << "  " << claim["id"].get<std::string>() << "  "
                << (holds.is_null()     ? "not tested"
                    : holds.get<bool>() ? "true      "
                                        : "false     ")
                << "  " << claim["text"].get<std::string>() << "\n";
    }
  }
}

Exit work(const ReproductionRequest& request, const Tool& tool) {
  catch_interrupts(tool.common().quiet);
  if (!request.prepare) {
    tool.note(std::to_string(reproduction_plan(request)["steps"].size()) + " cells on " +
              std::to_string(request.jobs) +
              " cores; the time left is told from those that were measured");
  }
  Progress bar(tool.common().quiet);
  CellRunObserver observer;
  observer.stop_wanted = [] { return interrupted(); };
  observer.note = [&](const std::string& text) { bar.line(text); };
  observer.progress = [&](double done, const std::string& step) { bar.update(done, step); };
  const ReproductionOutcome outcome = reproduce(request, observer);
  bar.clear();
  if (!outcome.prepared.empty()) {
    std::cout << outcome.prepared.string() << "\n";
    tool.note("cells to be run by dcnn-sweep --plan " + outcome.prepared.string() +
              "; then this command again, until a report is there");
    return Exit::kDone;
  }
  tool.note(std::to_string(outcome.done) + " cells done, " + std::to_string(outcome.skipped) +
            " skipped, since they were finished");
  if (!outcome.finished) {
    tool.note("interrupted; what is finished is kept in " + request.out.string() +
              ", the same command goes on");
    return Exit::kInterrupted;
  }
  if (tool.common().json) {
    Tool::print(outcome.summary);
  } else {
    print_claims(outcome.summary, request.preset);
    std::cout << "report: " << outcome.report.string() << "\n";
  }
  return Exit::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-reproduce",
            "The paper's experiments in one report: noise (Fig. 5), time (Table I), claims.",
            kExamples);
  ReproductionRequest request;
  std::string repeat = "draws";
  int trainings = 20;
  bool plan_only = false;
  tool.option("--preset", request.preset, "how much of everything").one_of(kPresets).with_default();
  tool.output("--out", request.out, "folder for the report and all work [out/reproduce-PRESET]",
              {"no file: what is finished is not done again"});
  request.scene = "configs/sim/embedded.json";
  auto scene =
      tool.option("--scene", request.scene, "simulation of recordings named train and test (JSON)")
          .holds({FileKind::kScene})
          .with_default();
  tool.option("--data", request.data, "own recordings instead: one to train on, one to test on")
      .values(2, "recordings, one to train on and one to test on")
      .holds({FileKind::kRecording})
      .excludes(scene);
  tool.option("--models", request.models, "which models (default: all of the preset)");
  tool.option("--augment-only", request.augment_only,
              "the model that alone is noise-trained in the third reading")
      .with_default();
  tool.option("--repeat", repeat,
              "spread over draws of the test noise, or beside it over trainings")
      .one_of({"draws", "training"})
      .with_default();
  tool.option("--trainings", trainings, "how many, with --repeat training")
      .between(2, 1000)
      .with_default();
  tool.option("--epochs", request.epochs, "epochs, instead of the preset's").positive(1000000);
  tool.option("--draws", request.draws, "draws of the test noise, instead of the preset's")
      .between(1, 100000);
  tool.option("--commit", request.commit, "of the code, for the report").with_default();
  tool.flag("--plan", plan_only, "print the cells and their expected time, do nothing");
  tool.flag("--prepare", request.prepare,
            "plan the cells that come next for dcnn-sweep, print their folder, run none");
  auto jobs = tool.option("--jobs", request.jobs, "cells at a time (default: the processors)")
                  .between(1, 1024);
  const ReadFlags read(tool);
  const Doctor doctor(tool);
  const SeedFlag seed_flag(tool);
  tool.shares_work();

  return tool.run(argc, argv, [&] {
    request.read = read.words();
    request.accept = doctor.words();
    request.recipe = read.recipe();
    if (!jobs.given()) request.jobs = threads();
    request.programs = std::filesystem::canonical("/proc/self/exe").parent_path();
    request.seed = seed_flag.value();
    if (repeat == "training") request.trainings = trainings;
    if (request.out.empty()) request.out = "out/reproduce-" + request.preset;
    if (!plan_only) return work(request, tool);
    const Json plan = reproduction_plan(request);
    if (tool.common().json) {
      Tool::print(plan);
    } else {
      print_plan(plan);
    }
    return Exit::kDone;
  });
}
