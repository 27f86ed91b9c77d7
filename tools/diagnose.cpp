#include <iostream>

#include "dcnn/diagnosis/diagnose.h"
#include "support/progress.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-diagnose --sim sim.json --fit a.csv b.csv --holdout c.csv --out report\n";

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-diagnose", "Names the physics that a simulator leaves out.", kExamples);
  DiagnosisRequest request;
  std::filesystem::path out;
  auto& app = tool.app();
  app.add_option("--sim", request.simulator, "simulator of the tool (JSON)");
  app.add_option("--fit", request.fit, "recordings to learn from")->required();
  app.add_option("--holdout", request.holdout, "recordings to judge by");
  app.add_option("--out", out, "folder to write")->required();
  const ReadFlags read(app);
  return tool.run(argc, argv, [&] {
    request.read = read.options();
    const Json report = diagnose(request, [&](const std::string& text) { tool.note(text); });
    std::cout << report.dump(2) << "\n";
    return Exit::kDone;
  });
}
