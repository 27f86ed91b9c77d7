// SPDX-License-Identifier: Apache-2.0
#include "dcnn/identification/identify.h"

#include <iostream>

#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/identification/arm.h"
#include "dcnn/identification/payload.h"
#include "dcnn/import/summary.h"
#include "dcnn/physics/simulator.h"
#include "support/apart.h"
#include "support/doctor.h"
#include "support/tool.h"

namespace {

using namespace dcnn;
using Path = std::filesystem::path;

constexpr const char* kExamples =
    "  dcnn-identify log.csv --out sim.json                      # moving, force (and torque)\n"
    "  dcnn-identify poses.csv --out sim.json                    # poses at rest, with or without "
    "t\n"
    "  dcnn-identify a.csv b.csv --out sim.json --report report --mounting 0 0 -0.52\n"
    "  dcnn-identify log.csv --out sim.json --export urdf franka --export-to payload\n"
    "  dcnn-identify --from sim.json --export ur --export-to payload\n"
    "  dcnn-identify a.csv b.csv --system arm.json --holdout c.csv --out found.json   # a whole "
    "arm\n"
    "  dcnn-identify empty.csv --loaded with_tool.csv --system arm.json --urdf robot.urdf --out "
    "o.json\n"
    "\n"
    "Finds mass, centre of mass, inertia (where torques are logged), the sensor's offset and its\n"
    "mounting, with 95 % intervals, and says which motion would show what these logs do not.\n"
    "sim.json is the simulator that dcnn-diagnose compares with recordings. With --system it "
    "finds\n"
    "the links, the friction and the payload of an arm from joint torques or currents; --out is "
    "then\n"
    "the description with these links, which dcnn-diagnose takes as --system.";

struct Command {
  IdentifyRequest request;
  ArmRequest arm;
  std::vector<double> mounting;
  Path from, out, report, export_to;
  std::vector<std::string> formats, reading;  ///< reading: the options of ReadFlags
};

/// The files that it writes, and what these numbers are not sure of.
Json export_payload(const Command& command, const ToolModel& model,
                    const std::vector<std::string>& assumed, const Tool& tool) {
  PayloadBody payload = payload_of(model);
  payload.assumed = assumed;
  Json files = Json::array();
  for (const std::string& format : command.formats) {
    const Path file = command.export_to / payload_file(format);
    write_file(file, payload_text(format, payload));
    tool.note("payload     " + file.string());
    files.push_back({{"format", format}, {"file", file.string()}});
  }
  const std::string caution = not_identified(payload);
  if (!caution.empty() && !tool.common().json) std::cout << caution << "\n";
  return {{"payloads", files}, {"caution", caution.empty() ? Json() : Json(caution)}};
}

/// The command that goes on from what was found; the logs are read as they were here.
std::string diagnosis_of(const Command& command, const std::string& option, const Path& found,
                         const std::vector<Path>& logs) {
  // What went through standard output or came from standard input is to be in a file first.
  const bool streamed = is_standard_output(found);
  std::string text = "dcnn-diagnose " + option + " " +
                     (streamed ? "FOUND.json" : quoted_argument(found.string())) + " --fit";
  for (const Path& log : logs) {
    text += " " + (log == "-" ? "LOG.csv" : quoted_argument(log.string()));
  }
  for (const std::string& word : command.reading) text += " " + quoted_argument(word);
  return text + " --out report";
}

template <class Identification>
void write_report(const Command& command, const Identification& result) {
  if (command.report.empty()) return;
  std::filesystem::create_directories(command.report);
  write_file(command.report / "identify.json", to_json(result).dump(2) + "\n");
  write_file(command.report / "identify.txt", to_text(result));
}

/// Stops where the log is certainly misread, so that no number would be the tool's. Signs and axes
/// of the force, the mounting, a lag, an offset and a missing weight are what is identified, or
/// told beside it.
void examine(const Command& command, const Doctor& doctor, const Tool& tool) {
  doctor.examine(
      tool, {command.request.logs, command.request.read, "", ""},
      {"reaction", "force_sign", "force_axes", "mounting", "compensated", "delay", "zeroed"});
}

Exit identify(Command& command, const Doctor& doctor, const Tool& tool) {
  examine(command, doctor, tool);
  if (!command.mounting.empty()) {
    command.request.mounting_rpy =
        Eigen::Vector3d(command.mounting[0], command.mounting[1], command.mounting[2]);
  }
  const ToolIdentification result = identify_tool(command.request);
  FileSet files(command.out.parent_path());
  Json simulator = to_json(Simulator{result.model, {}});
  const std::vector<std::string> guesses = assumed(result);
  if (!guesses.empty()) simulator["tool"]["assumed"] = guesses;
  write_file(command.out, simulator.dump(2) + "\n");
  write_report(command, result);
  Json exported;
  if (!command.formats.empty()) exported = export_payload(command, result.model, guesses, tool);
  files.commit();
  for (const auto& note : result.notes) tool.note(note);
  const std::string next = diagnosis_of(command, "--sim", command.out, command.request.logs);
  if (tool.common().json) {
    Json json = to_json(result);
    if (!exported.is_null()) json.update(exported);
    json["next"] = next;
    Tool::print(json);
  } else {
    std::cout << to_text(result) << "Next: " << next << "\n";
  }
  return Exit::kDone;
}

Exit identify_joints(Command& command, const Doctor& doctor, const Tool& tool) {
  command.arm.logs = command.request.logs;
  std::vector<Path> logs = command.arm.logs;
  logs.insert(logs.end(), command.arm.loaded.begin(), command.arm.loaded.end());
  chain_of(command.arm);  // a faulty description is told before the logs are examined by it
  std::vector<std::string> own;
  if (command.arm.drive_gains) own.push_back("torque_unit");
  doctor.examine(tool, {logs, {}, "", command.arm.system, command.arm.urdf, command.arm.tip}, own);
  const ArmIdentification result = identify_arm(command.arm);
  FileSet files(command.out.parent_path());
  write_file(command.out, result.system.dump(2) + "\n");
  write_report(command, result);
  files.commit();
  for (const auto& note : result.notes) tool.note(note);
  const auto& judged = command.arm.loaded.empty() ? command.arm.logs : command.arm.loaded;
  // A diagnosis of joints needs their motion.
  const bool moving = result.lowpass_hz > 0.0;
  const std::string next = moving ? diagnosis_of(command, "--system", command.out, judged) : "";
  if (tool.common().json) {
    Json json = to_json(result);
    json["next"] = moving ? Json(next) : Json();
    Tool::print(json);
  } else {
    std::cout << to_text(result) << (moving ? "Next: " + next + "\n" : "");
  }
  return Exit::kDone;
}

/// The options of an arm; they have no meaning for a tool.
void add_arm_options(Tool& tool, Command& command, const Option& system) {
  tool.option("--urdf", command.arm.urdf,
              "the arm's URDF instead of a DH table; its inertias are "
              "the prior")
      .needs(system)
      .group("Arms");
  tool.option("--tip", command.arm.tip, "last link of the arm in the URDF (else its end)")
      .needs(system)
      .group("Arms");
  tool.option("--loaded", command.arm.loaded, "recordings with a payload at the flange")
      .holds({FileKind::kRecording})
      .needs(system)
      .group("Arms");
  tool.option("--holdout", command.arm.holdout, "recordings that decide nothing: the error on them")
      .holds({FileKind::kRecording})
      .needs(system)
      .group("Arms");
  tool.flag("--drive-gains", command.arm.drive_gains,
            "the torques have an unknown gain in each joint (needs --urdf)")
      .needs(system)
      .group("Arms");
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-identify",
            "Finds a tool's mass, centre of mass, inertia, sensor offset and mounting from "
            "recordings, without a simulator.",
            kExamples);
  Command command;
  bool rigid_alone = false;
  const auto logs = tool.option("logs", command.request.logs,
                                "recordings: poses with fx,fy,fz (and tx,ty,tz), moving or at rest")
                        .holds({FileKind::kRecording});
  const auto from =
      tool.option("--from", command.from, "export the tool of this sim.json; nothing is identified")
          .holds({FileKind::kSimulator});
  const auto out =
      tool.output("--out", command.out, "sim.json to write (of an arm: its description)");
  tool.output("--report", command.report, "folder for all numbers with their intervals",
              {"identify.json", "identify.txt"});
  tool.option("--mounting", command.mounting,
              "how the sensor is turned against the pose frame: rx ry rz [rad] (else estimated)")
      .values(3, "numbers rx ry rz [rad]");
  tool.flag("--rigid-alone", rigid_alone,
            "fit no friction, lag, cable or sensor fault beside the tool");
  tool.option("--export", command.formats, "write the payload for others")
      .one_of(payload_formats());
  std::vector<std::string> payloads;
  for (const auto& format : payload_formats()) payloads.push_back(payload_file(format));
  tool.output("--export-to", command.export_to, "folder for what --export writes", payloads);
  const auto system = tool.option("--system", command.arm.system,
                                  "a whole arm: joints' columns and DH table (JSON, \"kind\": "
                                  "\"axes\")")
                          .holds({FileKind::kSystem})
                          .group("Arms");
  add_arm_options(tool, command, system);
  tool.check([&] { expect_apart(command.request.logs, command.arm.holdout); });
  const ReadFlags read(tool);
  const Doctor doctor(tool);
  tool.shares_work();

  return tool.run(argc, argv, [&] {
    require(command.formats.empty() == command.export_to.empty(), Exit::kUsage,
            "--export and --export-to belong together");
    if (!command.formats.empty()) std::filesystem::create_directories(command.export_to);
    if (from.given()) {
      require(!logs.given() && !out.given() && !command.formats.empty(), Exit::kUsage,
              "--from takes --export and --export-to, and no recordings");
      const Simulator simulator = read_simulator(command.from);
      const Json body = read_json(command.from, Exit::kData)["tool"];
      FileSet files(command.export_to);
      const Json exported = export_payload(command, simulator.model,
                                           body.value("assumed", std::vector<std::string>{}), tool);
      files.commit();
      if (tool.common().json) Tool::print(exported);
      return Exit::kDone;
    }
    require(logs.given() && out.given(), Exit::kUsage,
            "give recordings and --out sim.json; see dcnn-identify --help");
    command.request.read = read.options();
    command.reading = read.words();
    if (read.recipe()) {
      command.reading.insert(command.reading.end(), {"--recipe", read.recipe()->string()});
    }
    if (system.given()) return identify_joints(command, doctor, tool);
    command.request.laws = !rigid_alone;
    return identify(command, doctor, tool);
  });
}
