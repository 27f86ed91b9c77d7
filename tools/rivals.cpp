// SPDX-License-Identifier: Apache-2.0
#include "dcnn/rivals/rivals.h"

#include <iostream>

#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/experiment/configuration.h"
#include "dcnn/experiment/remainder.h"
#include "dcnn/models/model.h"
#include "dcnn/physics/effect_words.h"
#include "support/apart.h"
#include "support/recipe_option.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-rivals --sim sim.json --fit a.csv b.csv --holdout c.csv --out rivals\n"
    "  dcnn-rivals --sim sim.json --fit a.csv --holdout c.csv --networks mlp dcnn --out rivals\n"
    "  tools/challenge --scenarios 30 --seed 1 --rivals --out out/challenge\n"
    "\n"
    "The regressions, on the laws of the catalogue, are STLSQ and its ensemble form, LASSO with\n"
    "cross-validation, orthogonal matching pursuit and greedy selection with BIC. The networks "
    "fit\n"
    "what the simulator leaves.";

void show(const std::string& method, const Json& report) {
  std::cout << method << ":";
  for (const Json& f : report["findings"]) {
    std::cout << " " << words_of_effect(f["effect"].get<std::string>());
    if (f["axis"].is_string()) std::cout << " " << words_of_axis(f["axis"].get<std::string>());
    std::cout << ",";
  }
  std::cout << " " << report["verdict"].get<std::string>() << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-rivals",
            "Other methods on the files of a diagnosis, as a measure for dcnn-diagnose: sparse "
            "regressions and networks.",
            kExamples);
  rivals::Request request;
  std::filesystem::path out;
  std::vector<std::string> networks;
  std::string preset = "quick";
  tool.option("--sim", request.simulator, "simulator of the tool (JSON)")
      .required()
      .holds({FileKind::kSimulator});
  tool.option("--fit", request.fit, "recordings to learn from")
      .required()
      .holds({FileKind::kRecording});
  tool.option("--holdout", request.holdout, "recordings to judge by").holds({FileKind::kRecording});
  std::vector<std::string> models;
  for (const ModelKind* kind : model_kinds()) models.emplace_back(kind->name);
  tool.option("--networks", networks, "models of dcnn-train that learn the remainder too")
      .one_of(models);
  tool.option("--preset", preset, "of the networks").one_of(kPresets).with_default();
  tool.output("--out", out, "folder for <method>/report.json",
              {"stlsq*", "lasso*", "omp*", "greedy*"})
      .required();

  std::optional<std::filesystem::path> recipe;
  add_recipe_option(tool, recipe);
  tool.check([&] { expect_apart(request.fit, request.holdout); });
  tool.shares_work();

  return tool.run(argc, argv, [&] {
    if (recipe) read_by_recipe(*recipe);
    Json reports = rivals::run(request);
    for (const std::string& network : networks) {
      reports[network] = learn_remainder(
          {network, preset, request.simulator, request.fit, request.holdout, out / network});
    }
    FileSet files(out);
    for (const auto& [method, report] : reports.items()) {
      write_file(out / method / "report.json", report.dump(1) + "\n");
      if (!tool.common().json) show(method, report);
    }
    files.commit();
    if (tool.common().json) Tool::print(reports);
    return Exit::kDone;
  });
}
