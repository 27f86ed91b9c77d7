// SPDX-License-Identifier: Apache-2.0
#include "support/doctor.h"

#include <algorithm>

#include "dcnn/data/file_names.h"
#include "dcnn/identification/urdf.h"
#include "dcnn/physics/axis_machine.h"
#include "dcnn/physics/simulator.h"

namespace dcnn {
namespace {

/// `also`: other columns and recordings of which the same is true.
std::string line_of(const std::string& log, const check::Fault& fault,
                    const std::vector<std::string>& also = {}) {
  std::string same;
  for (const std::string& name : also) same += (same.empty() ? "; the same in " : ", ") + name;
  return log + ": " + fault.id + ": " + fault.words + same + "; " + fault.remedy +
         (fault.flag.empty() ? "" : " (" + fault.flag + ")");
}

std::optional<JointChain> arm_of(const CheckRequest& request, const System& system,
                                 const check::Log& log) {
  if (request.urdf.empty()) {
    if (system.arm.is_null()) return std::nullopt;
    return parse_chain(system.arm, request.system.string(), Exit::kData);
  }
  std::vector<std::string> names;
  for (const check::Joint& joint : log.joints) names.push_back(joint.name);
  JointChain chain = read_urdf_chain(request.urdf, request.tip, names);
  set_gravity(system.arm, request.system.string() + ": arm", Exit::kData, chain);
  return chain;
}

std::vector<std::filesystem::path> files_in(const std::vector<std::filesystem::path>& logs) {
  std::vector<std::filesystem::path> files;
  std::copy_if(logs.begin(), logs.end(), std::back_inserter(files),
               [](const auto& path) { return std::filesystem::is_regular_file(path); });
  return files;
}

}  // namespace

std::vector<Suspicion> suspicions(const std::vector<check::Report>& reports) {
  struct Kind {
    const check::Report* report;
    const check::Fault* first;
    std::vector<std::string> also = {};
  };
  std::vector<Kind> kinds;
  for (const check::Report& report : reports) {
    for (const check::Fault& fault : report.faults) {
      if (fault.probability < check::kLikely) continue;
      const auto known = std::find_if(kinds.begin(), kinds.end(),
                                      [&](const Kind& k) { return k.first->id == fault.id; });
      if (known == kinds.end()) {
        kinds.push_back({&report, &fault});
        continue;
      }
      const std::string& name = known->report == &report ? fault.channel : report.log;
      auto& also = known->also;
      const bool told = name.empty() || std::find(also.begin(), also.end(), name) != also.end();
      if (!told) also.push_back(name);
    }
  }
  std::vector<Suspicion> likely;
  for (const Kind& kind : kinds) {
    likely.push_back(
        {kind.first->id, "likely: " + line_of(kind.report->log, *kind.first, kind.also)});
  }
  return likely;
}

std::vector<check::Report> check_logs(const CheckRequest& request) {
  check::Declared declared;
  declared.read = request.read;
  if (!request.system.empty()) {
    declared.system = system_in(read_json(request.system, Exit::kData), request.system.string());
  }
  if (!request.simulator.empty()) declared.model = read_simulator(request.simulator).model;
  std::vector<check::Report> reports;
  const std::vector<std::filesystem::path> files = files_in(request.logs);
  for (const auto& path : files) {
    check::Log log = check::read_log(path, declared);
    log.name = distinct_name(path, files);
    const std::optional<JointChain> arm = arm_of(request, declared.system, log);
    if (arm && arm->bodies()) describe_arm(log, *arm);
    reports.push_back(check::check(log));
    if (arm && !arm->bodies()) {
      reports.back().notes.push_back(
          "the arm's description has no masses of its links: signs, zeros and orders of its joints "
          "were not compared");
    }
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

Examined Doctor::examine(const Tool& tool, const CheckRequest& request,
                         const std::vector<std::string>& own) const {
  Examined examined;
  const auto files = files_in(request.logs);
  std::vector<check::Report> reports = check_logs(request);
  for (std::size_t k = 0; k < reports.size(); ++k) {
    check::Report& report = reports[k];
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
      const bool accepted =
          std::find(accepted_.begin(), accepted_.end(), fault.id) != accepted_.end();
      if (accepted) continue;
      if (fault.id == "zeroed") examined.zeroed.push_back(files[k]);
      if (fault.id == "frozen" && fault.interval_s) {
        const auto [begin, end] = *fault.interval_s;
        examined.frozen.push_back({files[k], begin, end, fault.channel});
      }
    }
  }
  examined.likely = suspicions(reports);
  for (const Suspicion& one : examined.likely) tool.note(one.line);
  return examined;
}

}  // namespace dcnn
