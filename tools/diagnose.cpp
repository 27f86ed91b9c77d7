// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>

#include "dcnn/design/design.h"
#include "dcnn/experiment/diagnosis_report.h"
#include "dcnn/experiment/least_sizes.h"
#include "dcnn/identification/urdf.h"
#include "support/apart.h"
#include "support/doctor.h"
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
    "  dcnn-diagnose --system arm.json --urdf robot.urdf --fit a.csv --out report     # an arm\n"
    "  dcnn-sim --sim report/model.json --motion c.csv --out corrected.csv\n";

/// Effects of the catalogue as which the diagnosis finds a fault of the check; none of others.
std::vector<std::string> effects_of(const std::string& fault) {
  if (fault == "delay") return {"time_delay", "lowpass", "flexible_resonance"};
  if (fault == "mounting") return {"misalignment", "gravity_tilt", "crosstalk"};
  if (fault == "contact" || fault == "saturation" || fault == "quantisation") return {fault};
  return {};
}

bool is_named(const Json& report, const std::vector<std::string>& effects) {
  const auto wanted = [&](const std::string& effect) {
    return std::find(effects.begin(), effects.end(), effect) != effects.end();
  };
  for (const Json& finding : report["findings"]) {
    if (wanted(finding["effect"])) return true;
    for (const Json& other : finding.value("alternatives", Json::array())) {
      if (wanted(other)) return true;
    }
  }
  return false;
}

/// What the check of the recordings found, before everything else. It weighs a fault beside rigid
/// bodies alone, the diagnosis beside all physics that it knows: what that does not bear out is
/// said to be so.
Json with_check(const std::vector<Suspicion>& likely, const Json& report) {
  Json out;
  out["check"] = Json::array();
  for (const Suspicion& one : likely) {
    const auto effects = effects_of(one.fault);
    const bool is_refuted = !effects.empty() && !is_named(report, effects);
    out["check"].push_back(
        one.line +
        (is_refuted ? "; the diagnosis, which weighs it beside other causes, finds none" : ""));
  }
  out.update(report);
  return out;
}

/// The links of a URDF for a description of axes, which says how the base is mounted; what is no
/// such description is refused where it is read.
Json arm_of(const std::filesystem::path& urdf, const std::string& tip,
            const std::filesystem::path& system) {
  const Json json = read_json(system, Exit::kData);
  const bool is_system = json.is_object() && json.contains("axes") && json["axes"].is_array();
  std::vector<std::string> names;
  for (const Json& axis : is_system ? json["axes"] : Json::array()) {
    if (axis.is_object() && axis.contains("name") && axis["name"].is_string())
      names.push_back(axis["name"]);
  }
  JointChain chain = read_urdf_chain(urdf, tip, names);
  if (is_system) {
    set_gravity(json.value("arm", Json()), system.string() + ": arm", Exit::kData, chain);
  }
  return to_json(chain);
}

/// What is likely; recordings that were likely zeroed are taken for such, frozen rows left out.
std::vector<Suspicion> checked(const Tool& tool, const Doctor& doctor,
                               const std::filesystem::path& urdf, const std::string& tip,
                               DiagnosisRequest& request) {
  CheckRequest logs{
      request.fit, request.read, request.simulator.value_or(""), request.system.value_or(""),
      urdf,        tip};
  logs.logs.insert(logs.logs.end(), request.holdout.begin(), request.holdout.end());
  Examined examined = doctor.examine(tool, logs);
  if (!request.system && request.zeroed.empty()) request.zeroed = std::move(examined.zeroed);
  for (const auto& [log, begin, end, channel] : examined.frozen) {
    request.no_readings.push_back({log, begin, end, channel});
  }
  return examined.likely;
}

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
                  "simulator of the tool (JSON); without it the recordings need columns *_sim")
          .holds({FileKind::kSimulator});
  const auto system =
      tool.option(
              "--system", request.system,
              "another machine instead of --sim: its description (JSON, \"kind\": \"axes\"), or "
              "model.json of an earlier diagnosis as the simulator")
          .excludes(sim)
          .holds({FileKind::kSystem, FileKind::kMachine});
  std::filesystem::path urdf;
  std::string tip;
  const auto arm =
      tool.option("--urdf", urdf,
                  "URDF of the arm whose joints --system lists, instead of a DH table; "
                  "its inertias are the simulator at hand");
  arm.needs(system).group("Arms");
  tool.option("--tip", tip, "last link of the arm in the URDF (else its end)")
      .needs(arm)
      .group("Arms");
  tool.option("--fit", request.fit, "recordings to learn from")
      .required()
      .holds({FileKind::kRecording});
  tool.option("--holdout", request.holdout,
              "recordings to judge by (default: every fifth piece of the others)")
      .holds({FileKind::kRecording});
  tool.option("--clock", clock, "whether the recordings share one clock: auto, shared, own")
      .one_of({"auto", "shared", "own"})
      .with_default();
  tool.output("--out", out, "folder for report.json, report.html, model.json and predictions",
              {"report.json", "report.html", "model.json", "holdout_*_pred.csv"})
      .required();
  bool zeroed = false;
  tool.flag("--zeroed", zeroed,
            "the sensor was set to zero for each recording: its offset is estimated for each, and "
            "a constant one has no name (else as dcnn-check finds)")
      .excludes(system)
      .group("Reading recordings");
  tool.option(
          "--signals", request.signals,
          "columns that the strength of a law may follow, such as a pressure (temperature is one "
          "where it is logged)")
      .excludes(system)
      .group("Reading recordings");
  std::vector<std::string> without;
  tool.option(
          "--without", without,
          "leave out parts of the method, or effects of the catalogue, to see what they are worth")
      .one_of(ablations())
      .group("For research");
  tool.check([&] { expect_apart(request.fit, request.holdout); });
  const ReadFlags read(tool);
  const Doctor doctor(tool);
  tool.shares_work();

  return tool.run(argc, argv, [&] {
    request.read = read.options();
    request.read.part_of_wrench = true;
    if (!urdf.empty()) {
      request.arm = arm_of(urdf, tip, *request.system);
    }
    if (zeroed) request.zeroed = request.fit;
    if (zeroed)
      request.zeroed.insert(request.zeroed.end(), request.holdout.begin(), request.holdout.end());
    const std::vector<Suspicion> check = checked(tool, doctor, urdf, tip, request);
    request.without = ablation_of(without);
    if (clock != "auto") request.shared_clock = clock == "shared";
    Progress bar(tool.common().quiet);
    Diagnosis diagnosis = diagnose(request, [&](const std::string& text) { bar.line(text); });
    add_least_sizes(request, diagnosis);
    bar.line("designing the next motion");
    diagnosis.report["next_motion"] = design::next_motion(request, diagnosis);
    bar.clear();
    diagnosis.report = with_check(check, diagnosis.report);
    write_diagnosis(out, diagnosis);
    tool.note("report      " + (out / "report.html").string());
    if (tool.common().json) {
      Tool::print(diagnosis.report);
    } else {
      for (const Json& line : diagnosis.report["check"])
        std::cout << line.get<std::string>() << "\n";
      std::cout << to_text(diagnosis);
    }
    return Exit::kDone;
  });
}
