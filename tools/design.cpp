// SPDX-License-Identifier: Apache-2.0
#include "dcnn/design/design.h"

#include <iostream>

#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "support/progress.h"
#include "support/tool.h"

namespace {

using namespace dcnn;
using design::Design;
using design::DesignRequest;
using Path = std::filesystem::path;

constexpr const char* kExamples =
    "  dcnn-design --report report --limits configs/limits/wrist.json --seconds 30 --out "
    "motion.csv\n"
    "  dcnn-diagnose --sim sim.json --fit first.csv second.csv --out decided   # with what was "
    "recorded on it\n";

/// A file of the folder that dcnn-diagnose wrote.
Path file_of(const Path& folder, const char* name) {
  namespace fs = std::filesystem;
  std::error_code error;
  const char* is = !fs::exists(folder, error)          ? ": does not exist"
                   : !fs::is_directory(folder, error)  ? ": is a file"
                   : !fs::exists(folder / name, error) ? ": is a folder without "
                                                       : nullptr;
  if (is == nullptr) return folder / name;
  fail(Exit::kData, folder.string(), is, fs::is_directory(folder, error) ? name : "",
       "; --report takes the folder with report.json and model.json that dcnn-diagnose --sim "
       "sim.json --fit log.csv --out FOLDER writes");
}

/// The design beside what the report has.
void write_next_motion(const Path& folder, Json report, const Json& next, const Path& motion) {
  if (next.is_null()) return;
  report["next_motion"] = next;
  report["next_motion"]["design"] = motion.string();
  write_file(folder / "report.json", report.dump(2) + "\n");
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-design",
            "Designs the motion, within a robot's limits, that best tells apart what a report of "
            "dcnn-diagnose leaves open, and says what it will decide and with which probability.",
            kExamples);
  DesignRequest request;
  Path report, limits, out;
  tool.option("--report", report, "folder of dcnn-diagnose").called("DIR").required();
  tool.reads([&] { return std::vector<Path>{report / "report.json", report / "model.json"}; });
  tool.option("--limits", limits, "what the robot may do (JSON)")
      .required()
      .holds({FileKind::kLimits});
  tool.option("--seconds", request.seconds, "length of the motion").with_default().positive(3600);
  tool.option("--evaluations", request.evaluations,
              "motions that are judged: time against a better one")
      .with_default()
      .between(1, 100000);
  tool.output("--out", out, "motion.csv to write: t, joints where the limits are of joints, pose")
      .required();
  const SeedFlag seed_flag(tool);
  tool.shares_work();

  return tool.run(argc, argv, [&] {
    const Path file = file_of(report, "report.json");
    request.where = file.string();
    request.report = read_json(file, Exit::kData);
    request.model = read_json(file_of(report, "model.json"), Exit::kData);
    request.limits = design::read_limits(limits);
    request.seed = seed_flag.value();
    Progress bar(tool.common().quiet);
    const Design made =
        design::make_design(request, [&](double share) { bar.update(share, "motions"); });
    bar.clear();
    FileSet files(report);
    write_csv(out, made.motion);
    const Json next = design::next_motion(made, request.seconds);
    write_next_motion(report, request.report, next, out);
    files.commit();
    if (tool.common().json) {
      Tool::print(design::to_json(made, request.seconds));
    } else {
      std::cout << design::to_text(made);
    }
    return Exit::kDone;
  });
}
