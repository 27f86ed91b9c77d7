#include "support/doctor.h"

#include <algorithm>

#include "dcnn/physics/axis_machine.h"
#include "dcnn/physics/simulator.h"

namespace dcnn {
namespace {

std::string line_of(const std::string& log, const check::Fault& fault) {
  return log + ": " + fault.id + ": " + fault.words + "; " + fault.remedy +
         (fault.flag.empty() ? "" : " (" + fault.flag + ")");
}

}  // namespace

std::vector<check::Report> check_logs(const CheckRequest& request) {
  check::Declared declared;
  declared.read = request.read;
  if (!request.system.empty()) {
    declared.system = system_in(read_json(request.system, Exit::kData), request.system.string());
  }
  if (!request.simulator.empty()) declared.model = read_simulator(request.simulator).model;
  std::vector<check::Report> reports;
  for (const auto& path : request.logs) {
    if (!std::filesystem::is_regular_file(path)) continue;
    reports.push_back(check::check(check::read_log(path, declared)));
  }
  return reports;
}

Doctor::Doctor(Tool& tool) {
  tool.option("--accept", accepted_,
              "go on although this fault of a recording is certain (names: dcnn-check --help)")
      .one_of(check::fault_names())
      .group("Reading recordings");
}

std::vector<std::string> Doctor::words() const {
  std::vector<std::string> words;
  for (const std::string& fault : accepted_) words.insert(words.end(), {"--accept", fault});
  return words;
}

std::vector<std::string> Doctor::examine(const Tool& tool, const CheckRequest& request,
                                         const std::vector<std::string>& own) const {
  std::vector<std::string> lines;
  for (check::Report& report : check_logs(request)) {
    std::erase_if(report.faults, [&](const check::Fault& fault) {
      if (fault.id == "clock_order") return true;  // every reader refuses it, with the line
      if (fault.id == "jitter" && request.read.resample) return true;
      return std::find(own.begin(), own.end(), fault.id) != own.end();
    });
    if (const check::Fault* fault = report.stopping(accepted_)) {
      fail(Exit::kData, line_of(report.log, *fault), "; --accept ", fault->id, " goes on as it is");
    }
    for (const check::Fault& fault : report.faults) {
      if (fault.probability < check::kLikely) continue;
      lines.push_back("likely: " + line_of(report.log, fault));
      tool.note(lines.back());
    }
  }
  return lines;
}

}  // namespace dcnn
