// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "dcnn/experiment/check_report.h"
#include "dcnn/import/assemble.h"
#include "support/doctor.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-check log.csv                            # what is wrong with it, and what mends it\n"
    "  dcnn-check log.csv --sim sim.json --out check # with the nominal mass and mounting; a page\n"
    "  dcnn-check a.csv b.csv --system arm.json --json\n"
    "  dcnn-check joints.csv --urdf robot.urdf       # q_1, qd_1, tau_1, … beside its links\n"
    "\n"
    "A log is read in every way that people write logs by mistake (units, signs, axes, frames,\n"
    "orders), and a rigid tool is fitted to each; clocks, channels and rows have statistics of "
    "their\n"
    "own. Probabilities are posteriors with the priors of docs/use/check.md.\n\n";

std::string examples() {
  std::string text = kExamples;
  text += "Faults:";
  std::size_t width = 7;
  for (const std::string& name : check::fault_names()) {
    if (width + name.size() + 1 > 90) text += "\n       ", width = 7;
    text += " " + name;
    width += name.size() + 1;
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-check", "Says what is wrong with a recording before anything is learned from it.",
            examples());
  CheckRequest request;
  std::filesystem::path out;
  tool.option("logs", request.logs, "recordings (CSV)").required().holds({FileKind::kRecording});
  const Option sim = tool.option("--sim", request.simulator,
                                 "simulator of the tool (JSON): nominal mass, mounting")
                         .holds({FileKind::kSimulator});
  tool.option("--system", request.system, "system description of another machine (JSON)")
      .excludes(sim)
      .holds({FileKind::kSystem, FileKind::kMachine});
  const Option arm =
      tool.option("--urdf", request.urdf,
                  "URDF of the arm whose joints were logged: signs, orders, zeros and units of its "
                  "joints are compared with its links")
          .excludes(sim);
  arm.group("Arms");
  tool.option("--tip", request.tip, "last link of the arm in the URDF (else its end)")
      .needs(arm)
      .group("Arms");
  const Output folder = tool.output("--out", out, "folder for check.json and check.html",
                                    {"check.json", "check.html"});
  const ReadFlags read(tool);
  tool.shares_work();

  return tool.run(argc, argv, [&] {
    request.read = read.options();
    for (const auto& log : request.logs) {
      require(log != "-", Exit::kUsage,
              "a log is read twice: write standard input to a file first");
      // By a recipe a log may be several files, a.txt+b.txt, or the folder of a bag.
      for (const auto& part : split_paths(log)) {
        std::error_code error;
        require(std::filesystem::exists(part, error), Exit::kData, part.string(),
                ": does not exist or cannot be reached; check the path");
        const bool usable = read.recipe() || std::filesystem::is_regular_file(part, error);
        require(usable, Exit::kData, part.string(),
                ": is no file; give a recording (CSV), or a log with --recipe");
      }
    }
    const auto reports = check_logs(request);
    if (folder.given()) {
      write_check(out, reports);
      tool.note("report      " + (out / "check.html").string());
    }
    if (tool.common().json) {
      Tool::print(check_json(reports));
    } else {
      for (const auto& report : reports) std::cout << check::to_text(report);
    }
    return Exit::kDone;
  });
}
