#include "dcnn/rivals/rivals.h"

#include <iostream>

#include "dcnn/core/file.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-rivals --sim sim.json --fit a.csv b.csv --holdout c.csv --out rivals\n"
    "  tools/challenge --scenarios 30 --seed 1 --rivals --out out/challenge\n";

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-rivals",
            "Sparse regressions on the laws of the catalogue, as a measure for dcnn-diagnose: "
            "STLSQ, its ensemble form, LASSO with cross-validation, orthogonal matching pursuit "
            "and greedy forward selection with BIC.",
            kExamples);
  rivals::Request request;
  std::filesystem::path out;
  auto& app = tool.app();
  app.add_option("--sim", request.simulator, "simulator of the tool (JSON)")->required();
  app.add_option("--fit", request.fit, "recordings to learn from")->required();
  app.add_option("--holdout", request.holdout, "recordings to judge by");
  app.add_option("--out", out, "folder for <method>/report.json")->required();

  return tool.run(argc, argv, [&] {
    const Json reports = rivals::run(request);
    for (const auto& [method, report] : reports.items()) {
      write_file(out / method / "report.json", report.dump(1) + "\n");
      if (tool.common().json) continue;
      std::cout << method << ":";
      for (const Json& f : report["findings"]) {
        std::cout << " " << f["effect"].get<std::string>();
        if (f["axis"].is_string()) std::cout << " " << f["axis"].get<std::string>();
        std::cout << ",";
      }
      std::cout << " " << report["verdict"].get<std::string>() << "\n";
    }
    if (tool.common().json) Tool::print(reports);
    return Exit::kDone;
  });
}
