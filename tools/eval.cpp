// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <iostream>

#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/experiment/evaluate.h"
#include "support/progress.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-eval model.dcnn --data test.csv\n"
    "  dcnn-eval a.dcnn b.dcnn --data test.csv --snr clean,40,30,20,10 --runs 20 --out report\n"
    "  dcnn-eval model.dcnn --data test.csv --noise-on pose\n"
    "  dcnn-eval model.dcnn --data test.csv --snr clean --json | jq .summary\n";

std::vector<SnrLevel> parse_levels(const std::string& text) {
  std::vector<SnrLevel> levels;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const auto end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    if (word == "clean") {
      levels.emplace_back();
      continue;
    }
    double value = 0.0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    require(error == std::errc() && stop == word.data() + word.size() && !word.empty(),
            Exit::kUsage, "--snr: '", word, "' is neither 'clean' nor a number of dB");
    levels.emplace_back(value);
  }
  return levels;
}

void write_report(const std::filesystem::path& folder, const Evaluation& evaluation,
                  const EvaluationRequest& request) {
  FileSet files(folder);
  write_file(folder / "evaluation.json", to_json(evaluation).dump(2) + "\n");
  write_file(folder / "report.html", to_html(evaluation, request));
  files.commit();
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-eval",
            "Scores trained models on recordings: RMSE per axis over levels of input noise.",
            kExamples);
  EvaluationRequest request;
  std::string levels = "clean,40,30,20,10", noise_mode = "feature", noise_on = "features";
  std::filesystem::path out, trace;
  tool.option("models", request.models, "model files").required().holds({FileKind::kModel});
  tool.option("--data", request.data, "recordings to score on")
      .required()
      .holds({FileKind::kRecording});
  tool.option("--snr", levels, "signal-to-noise ratios of the input [dB], or clean").with_default();
  tool.option("--runs", request.runs, "noise draws per level").between(1, 100000).with_default();
  tool.option("--noise-mode", noise_mode,
              "power of the noise: per feature, or as MATLAB's awgn 'measured'")
      .one_of({"feature", "matlab"})
      .with_default();
  tool.option(
          "--noise-on", noise_on,
          "what the noise is added to: the features, the pose they are derived from, or (a leak) "
          "the entries of X* of models that have them")
      .one_of({"features", "pose", "entries"})
      .with_default();
  tool.output("--out", out, "folder for report.html and evaluation.json",
              {"report.html", "evaluation.json"});
  tool.option("--every", request.every, "score the first and every so manyth sample after it")
      .positive();
  tool.output("--trace", trace,
              "CSV of the measured forces and those of the first model, without added noise");
  const PrecisionFlag precision(tool);
  const ReadFlags read(tool);
  const SeedFlag seed_flag(tool);
  tool.shares_work();

  return tool.run(argc, argv, [&] {
    request.levels = parse_levels(levels);
    request.matlab_noise = noise_mode == "matlab";
    if (noise_on == "pose") request.noise_on = NoiseSpec::Signal::kPose;
    request.noisy_entries = noise_on == "entries";
    request.seed = seed_flag.value();
    request.read = read.options();
    request.precision = precision.value();
    Progress bar(tool.common().quiet);
    const Evaluation evaluation = evaluate(request, [&](int done, int total) {
      bar.update(double(done) / total,
                 std::to_string(done) + "/" + std::to_string(total) + " predictions");
    });
    bar.clear();
    for (const auto& note : evaluation.notes) tool.note(note);
    if (evaluation.singular_samples > 0) {
      tool.note(std::to_string(evaluation.singular_samples) + " of " +
                std::to_string(evaluation.samples) +
                " samples lie near the Euler singularity: a model on the set 'pose' cannot know "
                "them; 'body' can");
    }
    if (!out.empty()) {
      write_report(out, evaluation, request);
      tool.note("report      " + (out / "report.html").string());
    }
    if (!trace.empty()) write_trace(trace, evaluation);
    if (tool.common().json) {
      Tool::print(to_json(evaluation));
    } else {
      std::cout << to_text(evaluation);
    }
    return Exit::kDone;
  });
}
