// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "dcnn/core/file.h"
#include "dcnn/core/number.h"
#include "dcnn/identification/forward_fit.h"
#include "support/tool.h"

namespace {

using namespace dcnn;
using Path = std::filesystem::path;

constexpr const char* kExamples =
    "  dcnn-forward report/model.json --data test.csv --out simulated.csv\n"
    "  dcnn-forward report/model.json --fit train.csv --save refined.json --data test.csv\n"
    "\n"
    "Simulates the motion of a machine's axis from its drive alone, from the first logged "
    "position\n"
    "on: model.json is what dcnn-diagnose --system wrote. --fit refines the model's numbers, not "
    "its\n"
    "structure, so that the simulated position follows these recordings.";

struct Command {
  Path model;
  std::vector<Path> fit;
  std::optional<Path> data, out, save;
  std::string axis;
};

std::size_t axis_of(const AxisMachine& machine, const std::string& name) {
  const auto& axes = machine.system.axes;
  if (name.empty() && axes.size() == 1) return 0;
  std::string all;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    if (axes[k].name == name) return k;
    all += (k ? ", " : "") + axes[k].name;
  }
  throw Error(Exit::kUsage, name.empty() ? "give --axis, one of " + all
                                         : "--axis " + name + ": the model has " + all);
}

Json numbers_json(const ForwardFit& fit) {
  Json list = Json::array();
  for (std::size_t k = 0; k < fit.names.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    list.push_back({{"name", fit.names[k]},
                    {"before", fit.before(i)},
                    {"after", fit.after(i)},
                    {"deviation", fit.deviation(i)}});
  }
  return list;
}

Exit forward(const Command& command, const ReadOptions& read, const Tool& tool) {
  AxisMachine machine = parse_axis_machine(read_json(command.model, Exit::kModel),
                                           command.model.string(), Exit::kModel);
  const std::size_t axis = axis_of(machine, command.axis);
  std::vector<std::string> left_out;
  machine = forward_part(std::move(machine), axis, left_out);
  for (const std::string& effect : left_out) {
    tool.note("left out: " + effect + ", which is no force that the motion at hand makes");
  }
  const Axis& own = machine.system.axes[axis];
  const std::string unit = " " + own.position_unit;
  Json summary = {{"axis", own.name}, {"position_unit", own.position_unit}, {"left_out", left_out}};
  std::string text;
  if (!command.fit.empty()) {
    std::vector<Recording> recordings;
    for (const Path& file : command.fit) {
      recordings.push_back(read_recording(file, read, machine.system));
    }
    const ForwardFit fit = refine_forward(machine, axis, recordings,
                                          [&](const std::string& line) { tool.note(line); });
    machine = fit.machine;
    summary["numbers"] = numbers_json(fit);
    summary["fit_rmse_before"] = fit.rmse_before;
    summary["fit_rmse_after"] = fit.rmse_after;
    text += "refined     fitted error " + brief(fit.rmse_before) + " -> " + brief(fit.rmse_after) +
            unit + "\n";
    for (std::size_t k = 0; k < fit.names.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      text += "            " + fit.names[k] + " " + brief(fit.before(i)) + " -> " +
              brief(fit.after(i)) + " +- " + brief(fit.deviation(i)) + "\n";
    }
    if (command.save) write_file(*command.save, to_json(machine).dump(2) + "\n");
  }
  if (command.data) {
    Recording recording = read_recording(*command.data, read, machine.system);
    const Eigen::MatrixXd motion = simulated_motion(machine, axis, recording);
    const ForwardError error = error_of(motion, recording, own);
    summary["recording"] = recording.name;
    summary["rmse"] = error.whole;
    summary["rmse_settled"] = error.settled;
    text += "simulated   error " + brief(error.whole) + unit + ", " + brief(error.settled) + unit +
            " without the first twentieth\n";
    recording.set(own.position + "_hat", motion.col(0));
    if (command.out) write_csv(*command.out, recording.table);
  }
  if (command.out == Path("-")) return Exit::kDone;  // standard output holds the rows
  if (tool.common().json) {
    Tool::print(summary);
  } else {
    std::cout << text;
  }
  return Exit::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-forward", "Simulates the motion that a machine's drive makes.", kExamples);
  Command command;
  tool.option("model", command.model, "model.json of a machine, by dcnn-diagnose --system")
      .required()
      .holds({FileKind::kMachine});
  tool.option("--data", command.data, "recording whose drive is simulated")
      .holds({FileKind::kRecording});
  tool.option("--axis", command.axis, "name of the axis, where there are several");
  tool.output("--out", command.out, "CSV to write: the input columns and <position>_hat");
  tool.option("--fit", command.fit, "recordings that the simulated position is to follow")
      .holds({FileKind::kRecording});
  tool.output("--save", command.save, "the model with the refined numbers");
  const ReadFlags read(tool);
  tool.check([&] {
    require(command.data || !command.fit.empty(), Exit::kUsage,
            "give --data to simulate, --fit to refine, or both");
    require(!command.save || !command.fit.empty(), Exit::kUsage,
            "--save is for the model that --fit refines");
  });
  tool.shares_work();

  return tool.run(argc, argv, [&] { return forward(command, read.options(), tool); });
}
