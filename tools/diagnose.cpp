#include <iostream>

#include "dcnn/experiment/diagnosis_report.h"
#include "support/progress.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-diagnose --sim sim.json --fit a.csv b.csv --holdout c.csv --out report\n"
    "  dcnn-diagnose --sim sim.json --fit a.csv --out report       # holds out blocks of a.csv\n"
    "  dcnn-diagnose --fit log.csv --out report                    # log.csv has "
    "fx_sim,fy_sim,fz_sim\n"
    "  dcnn-diagnose --system arm.json --fit a.csv --holdout b.csv --out report   # another "
    "machine\n"
    "  dcnn-sim --sim report/model.json --motion c.csv --out corrected.csv\n";

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-diagnose",
            "Compares a simulator with recordings: says where they differ, names the physics that "
            "is missing, models it, and shows the error on held-out data fall.",
            kExamples);
  DiagnosisRequest request;
  std::filesystem::path out;
  std::string clock = "auto";
  const auto sim =
      tool.option("--sim", request.simulator,
                  "simulator of the tool (JSON); without it the recordings need columns *_sim");
  tool.option("--system", request.system,
              "system description of another machine (JSON, \"kind\": \"axes\"), instead of --sim")
      .excludes(sim);
  tool.option("--fit", request.fit, "recordings to learn from").required();
  tool.option("--holdout", request.holdout,
              "recordings to judge by (default: every fifth block of 5 s of the others)");
  tool.option("--clock", clock, "whether the recordings share one clock: auto, shared, own")
      .one_of({"auto", "shared", "own"})
      .with_default();
  tool.output("--out", out, "folder for report.json, report.html, model.json and predictions",
              {"report.json", "report.html", "model.json", "holdout_*_pred.csv"})
      .required();
  std::vector<std::string> without;
  tool.option("--without", without, "leave out parts of the method, to see what they are worth")
      .one_of(ablations())
      .group("For research");
  const ReadFlags read(tool);

  return tool.run(argc, argv, [&] {
    request.read = read.options();
    request.without = ablation_of(without);
    if (clock != "auto") request.shared_clock = clock == "shared";
    Progress bar(tool.common().quiet);
    const Diagnosis diagnosis = diagnose(request, [&](const std::string& text) { bar.line(text); });
    bar.clear();
    write_diagnosis(out, diagnosis);
    tool.note("report      " + (out / "report.html").string());
    if (tool.common().json) {
      Tool::print(diagnosis.report);
    } else {
      std::cout << to_text(diagnosis);
    }
    return Exit::kDone;
  });
}
