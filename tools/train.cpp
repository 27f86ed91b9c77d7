// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/train.h"

#include <chrono>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <set>

#include "dcnn/core/number.h"
#include "dcnn/core/ranks.h"
#include "dcnn/physics/effect_words.h"
#include "support/apart.h"
#include "support/doctor.h"
#include "support/interrupt.h"
#include "support/joined_ranks.h"
#include "support/progress.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-train --train data/sample/train.csv --preset quick --out model.dcnn\n"
    "  dcnn-train --config configs/ntnu_wrist.json --train a.csv b.csv --valid c.csv --out "
    "model.dcnn\n"
    "  dcnn-train --system configs/systems/davinci_tool.json --train run_00.csv --out tool.dcnn\n"
    "  dcnn-train ... --resume        # after Ctrl-C or a crash: goes on, same bytes in the end\n";

std::string epoch_text(const TrainingProgress& p) {
  char text[96];
  std::snprintf(text, sizeof text, "epoch %lld/%lld  loss %.5f", static_cast<long long>(p.epoch),
                static_cast<long long>(p.epochs), p.loss);
  return text;
}

std::string rmse_text(const EpochRecord& record) {
  if (record.validation_rmse.empty()) return "";
  std::string text = "  validation RMSE";
  for (const double value : record.validation_rmse) {
    char number[24];
    std::snprintf(number, sizeof number, " %.4f", value);
    text += number;
  }
  return text + (record.best ? "  *" : "");
}

class Observer {
 public:
  explicit Observer(const Tool& tool) : bar_(tool.common().quiet) {}

  TrainingObserver callbacks() {
    return {[] { return interrupted(); },
            [this](const std::string& text) {
              bar_.line(text);
              bar_.restart();  // another model, where several are tried
              last_.clear();
            },
            [this](const TrainingProgress& p) { show(p); }};
  }
  void clear() { bar_.clear(); }

 private:
  void show(const TrainingProgress& p) {
    if (p.finished) {
      last_ = rmse_text(*p.finished);
      bar_.line(epoch_text(p) + last_);
      return;
    }
    const double within = static_cast<double>(p.step) / static_cast<double>(p.steps);
    bar_.update((static_cast<double>(p.epoch - 1) + within) / static_cast<double>(p.epochs),
                epoch_text(p) + last_);
  }

  Progress bar_;
  std::string last_;
};

/// RMSE per target of one row of the comparison.
void print_row(const std::string& name, const Json& rmse) {
  if (rmse.size() == 0) return;  // null, or no noise among poses at rest
  std::cout << std::left << std::setw(24) << name << std::setprecision(4);
  for (const double value : rmse.get<std::vector<double>>()) std::cout << std::setw(12) << value;
  std::cout << "\n";
}

/// The validation error beside what no identification, the rigid tool and the noise come to.
void print_comparison(const Json& summary) {
  if (!summary.contains("references")) return;
  const Json& references = summary["references"];
  std::cout << std::left << std::setw(24) << "validation RMSE";
  for (std::size_t j = 0; j < summary["targets"].size(); ++j) {
    const auto unit = summary["units"][j].get<std::string>();
    const std::string shown = unit_text(unit);
    const auto more = static_cast<int>(shown.size() - unit.size());  // bytes of the same characters
    std::cout << std::setw(12 + more)
              << summary["targets"][j].get<std::string>() + " [" + shown + "]";
  }
  std::cout << "\n";
  print_row(summary["model"].get<std::string>(), summary["validation_rmse"]);
  print_row("rigid tool", references["rigid"]);
  print_row("no identification", references["none"]);
  print_row("white noise", references["white_noise"]);
}

/// "14155 parameters", "simulator with dry friction", or the one beside the other.
std::string size_of_model(const Json& summary) {
  std::string size;
  const auto count = summary["parameters"].get<Index>();
  if (count > 0 || !summary.contains("base_effects")) {
    size = std::to_string(count) + " parameters";
  }
  if (!summary.contains("base_effects")) return size;
  std::set<std::string> kinds;  // one may act along several axes
  std::string effects;
  for (const Json& name : summary["base_effects"]) {
    if (!kinds.insert(name.get<std::string>()).second) continue;
    effects += (kinds.size() == 1 ? " with " : ", ") + words_of_effect(name.get<std::string>());
  }
  return size + (size.empty() ? "" : " beside a ") + "simulator" + effects;
}

/// First whether the model is of use at all, then what the check of its recordings found.
void print_summary(const Json& summary, const std::vector<std::string>& check) {
  for (const Json& warning : summary.value("warnings", Json::array())) {
    std::cout << warning.get<std::string>() << "\n";
  }
  for (const std::string& line : check) std::cout << line << "\n";
  if (summary.contains("choice")) std::cout << summary["choice"]["why"].get<std::string>() << "\n";
  std::cout << "model       " << summary["file"].get<std::string>() << " ("
            << size_of_model(summary) << ")\n"
            << "rows        " << summary["training_rows"] << " training, "
            << summary["validation_rows"] << " validation\n";
  print_comparison(summary);
  if (summary.contains("trust")) {
    const auto trust = summary["trust"].get<std::vector<double>>();
    std::cout << "adds        of what it learned beside the simulator:";
    for (std::size_t j = 0; j < trust.size(); ++j) {
      std::cout << (j == 0 ? " " : ", ") << summary["targets"][j].get<std::string>() << " "
                << trust[j];
    }
    std::cout << " (as far as the validation rows bear it out)\n";
  }
  std::cout << "run         " << summary["run_directory"].get<std::string>() << "\n"
            << "next        dcnn-eval " << summary["file"].get<std::string>()
            << " --data TEST.csv\n";
}

/// What the check of the recordings found; a run that goes on was checked when it began.
std::vector<std::string> checked(const Tool& tool, const Doctor& doctor,
                                 const TrainingRequest& request) {
  if (request.resume) return {};
  CheckRequest logs{request.training, request.read, request.base.value_or(""),
                    request.configuration.system.value_or("")};
  logs.logs.insert(logs.logs.end(), request.validation.begin(), request.validation.end());
  // Where no simulator declares a mounting, models learn whatever it is.
  const std::vector<std::string> learned =
      request.base ? std::vector<std::string>{} : std::vector<std::string>{"mounting"};
  std::vector<std::string> lines;
  for (const Suspicion& one : doctor.examine(tool, logs, learned).likely) {
    lines.push_back(one.line);
  }
  return lines;
}

}  // namespace

int main(int argc, char** argv) {
  JoinedRanks ranks("dcnn-train");
  Tool tool("dcnn-train", "Learns the force a tool puts on its sensor from recordings (CSV).",
            kExamples);
  TrainingRequest request;
  ConfigurationFlags& flags = request.configuration;
  std::string list;
  for (const ModelKind* kind : model_kinds())
    list += std::string("\n  ") + kind->name + ": " + kind->summary;
  tool.option("--train", request.training, "recordings to learn from")
      .required()
      .holds({FileKind::kRecording});
  tool.option("--valid", request.validation,
              "recordings for validation (default: the last 15 % of each training recording)")
      .holds({FileKind::kRecording});
  tool.option("--config", flags.file, "configuration (JSON)").holds({FileKind::kTraining});
  tool.option("--preset", flags.preset,
              "fills what the configuration leaves out (default: standard)")
      .one_of(kPresets);
  tool.option("--model", flags.model,
              "which identifier (default: dcnn):" + list +
                  "\n  auto: the best of rigid, mlp, dcnn and physics (the tool identified, then "
                  "corrected by "
                  "a diagnosis) on rows that none was fitted to");
  tool.option("--system", flags.system, "description of another machine (JSON)")
      .holds({FileKind::kSystem});
  tool.option("--epochs", flags.epochs, "number of epochs").positive(1000000);
  tool.option("--base", request.base,
              "simulator (sim.json or model.json) whose remainder is learned")
      .holds({FileKind::kSimulator, FileKind::kMachine});
  tool.flag("--online", flags.online, "causal derivatives: required by dcnn-run and dcnn-teleop");
  const Option resume = tool.flag("--resume", request.resume, "go on from the last checkpoint");
  tool.output("--out", request.out, "model file to write; its run directory is beside it")
      .required()
      .unless(resume);
  tool.check([&] {
    expect_apart(request.training, request.validation);
    const bool stream =
        is_standard_output(request.out) ||
        (std::filesystem::exists(request.out) && !std::filesystem::is_regular_file(request.out) &&
         !std::filesystem::is_directory(request.out));
    require(!stream, Exit::kUsage, request.out.string(),
            " is no file, and the training's folder stands beside its model; name a file");
  });
  const ReadFlags read(tool);
  const Doctor doctor(tool);
  const SeedFlag seed_flag(tool, "the configuration's");
  tool.shares_work();

  return ranks.leave(tool.run(argc, argv, [&] {
    request.read = read.options();
    flags.seed = seed_flag.given();
    const auto run = run_directory(request.out);
    require(!is_first_rank() || request.resume || tool.common().force ||
                !std::filesystem::exists(run / "checkpoint.safetensors"),
            Exit::kUsage, run.string(),
            ": an interrupted run is here; go on with --resume, or start anew with --force");
    const std::vector<std::string> check = checked(tool, doctor, request);
    require(rank_count() == 1 || flags.model != "auto", Exit::kUsage,
            "--model auto tries models of one process; name one, or run dcnn-train without mpirun");
    catch_interrupts(tool.common().quiet || !is_first_rank());
    Observer observer(tool);
    const TrainingOutcome outcome = flags.model == "auto"
                                        ? train_best(request, observer.callbacks())
                                        : train(request, observer.callbacks());
    observer.clear();
    if (!outcome.finished) {
      tool.note("interrupted; the state is saved in " +
                outcome.summary["run_directory"].get<std::string>() +
                ", go on with the same command and --resume");
      return Exit::kInterrupted;
    }
    if (tool.common().json) {
      Tool::print(outcome.summary);
    } else {
      print_summary(outcome.summary, check);
    }
    ranks.print_times();
    return Exit::kDone;
  }));
}
