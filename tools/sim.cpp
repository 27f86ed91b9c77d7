// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "dcnn/physics/axis_machine.h"
#include "dcnn/physics/scenario.h"
#include "dcnn/physics/simulator.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-sim --config configs/sim/embedded.json --out data      # recordings, sim.json, "
    "truth.json\n"
    "  dcnn-sim --sim data/sim.json --motion log.csv --out b.csv   # what the simulator says to a "
    "motion\n"
    "  dcnn-sim --sim arm.json --motion log.csv --out torques.csv  # joint torques of an arm\n";

/// Recordings with ground truth from a configuration.
Json simulate_folder(const std::filesystem::path& config, const std::filesystem::path& out,
                     std::optional<std::uint64_t> seed) {
  const Scenario scenario = simulate_config(read_json(config, Exit::kUsage), config.string(), seed);
  write_scenario(scenario, out);
  Json files = Json::array();
  for (const auto& recording : scenario.recordings) {
    files.push_back({{"file", (out / (recording.name + ".csv")).string()},
                     {"samples", recording.noisy.samples()}});
  }
  return {{"recordings", files},
          {"simulator", (out / "sim.json").string()},
          {"truth", (out / "truth.json").string()}};
}

/// What a tool's sensor, or the drives of a machine, show on a logged motion.
Recording simulated(const std::filesystem::path& sim, const std::filesystem::path& motion,
                    const ReadOptions& read) {
  const Json json = read_json(sim, Exit::kData);
  if (is_axis_machine(json)) {
    const AxisMachine machine = parse_axis_machine(json, sim.string(), Exit::kData);
    return predict_motion(machine, read_recording(motion, read, machine.system));
  }
  if (json.is_object() && json.contains("axes")) {
    const AxisMachine machine = machine_of(parse_system(json, sim.string()));
    return predict_motion(machine, read_recording(motion, read, machine.system));
  }
  const Recording recording = read_recording(motion, read, System());
  return predict_motion(read_simulator(sim), recording, DerivativeSpec());
}

/// The simulator's prediction for a logged motion.
Json simulate_motion(const std::filesystem::path& sim, const std::filesystem::path& motion,
                     const std::filesystem::path& out, ReadOptions read) {
  read.motion_only = true;
  const Recording predicted = simulated(sim, motion, read);
  write_csv(out, predicted.table);
  return {{"recordings", {{{"file", out.string()}, {"samples", predicted.samples()}}}}};
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-sim",
            "Simulates recordings of a tool on a wrist sensor, with effects hidden in them, and "
            "the joint "
            "torques of arms.",
            kExamples);
  std::filesystem::path config, sim, motion, out;
  auto from_config =
      tool.option("--config", config, "what to simulate (JSON)").holds({FileKind::kScene});
  auto from_sim =
      tool.option("--sim", sim,
                  "simulator: sim.json, a corrected model.json, or an arm's description with the "
                  "bodies of its links")
          .holds({FileKind::kSimulator, FileKind::kMachine, FileKind::kSystem});
  auto with_motion = tool.option("--motion", motion, "recording whose motion is simulated")
                         .holds({FileKind::kRecording});
  from_sim.needs(with_motion).excludes(from_config);
  with_motion.needs(from_sim);
  tool.output("--out", out, "folder (with --config) or CSV file (with --motion) to write",
              {"sim.json", "truth.json", "*.csv"})
      .required()
      .file_with(with_motion);
  const ReadFlags read(tool);
  const SeedFlag seed_flag(tool, "the configuration's");

  return tool.run(argc, argv, [&] {
    require(!config.empty() || !sim.empty(), Exit::kUsage, "give --config, or --sim with --motion");
    const Json summary = sim.empty() ? simulate_folder(config, out, seed_flag.given())
                                     : simulate_motion(sim, motion, out, read.options());
    if (tool.common().json) {
      Tool::print(summary);
    } else {
      for (const auto& entry : summary["recordings"]) {
        std::cout << entry["file"].get<std::string>() << ": " << entry["samples"] << " samples\n";
      }
    }
    return Exit::kDone;
  });
}
