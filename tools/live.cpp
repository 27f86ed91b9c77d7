// SPDX-License-Identifier: Apache-2.0
#include "dcnn/teleop/live.h"

#include <iostream>

#include "dcnn/experiment/teleop_report.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  tools/teleop-live                                     # starts all three, 90 s\n"
    "  dcnn-run --model m.dcnn --fallback sim.json --listen 5301 --peer 5302 --key-file k &\n"
    "  dcnn-live --role controller --key-file k --out live &\n"
    "  dcnn-live --role sensor --key-file k\n"
    "\n"
    "The demonstration of dcnn-teleop in real time as three processes over UDP: sensor (slave, "
    "wall,\n"
    "force sensor), identifier (dcnn-run), controller (hand and master).";

/// The variant that ran live beside the ideal one, which runs here.
Json report(const TeleopConfig& config, TeleopTrace trace, const std::filesystem::path& out,
            std::uint64_t seed) {
  std::vector<TeleopResult> results;
  Variant ideal{"ideal", Variant::Kind::kIdeal, nullptr};
  TeleopTrace reference = run_teleop(config, ideal, Eigen::Matrix3d::Identity(), seed);
  Json first = summarise(reference, config, "ideal"), second = summarise(trace, config, "live");
  results.push_back({"ideal", std::move(reference), first});
  results.push_back({"live", std::move(trace), second});
  write_teleop(out, config, results, seed);
  return {{"variants", {first, second}}};
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-live", "One process of the live demonstration.", kExamples);
  std::filesystem::path config_path, key_file, out;
  std::string role;
  double seconds = 0.0;
  Ends identifier{"5302", "5301"}, sensor{"5303", "5304"};
  tool.option("--role", role, "sensor or controller").required().one_of({"sensor", "controller"});
  tool.option("--config", config_path, "configuration as for dcnn-teleop")
      .holds({FileKind::kTeleop});
  tool.option("--seconds", seconds, "shorter than the configuration's duration").positive();
  tool.option("--key-file", key_file, "the key of this run, the same for all").required();
  tool.option("--identifier-listen", identifier.listen, "own address towards dcnn-run")
      .with_default();
  tool.option("--identifier", identifier.peer, "address of dcnn-run").with_default();
  tool.option("--sensor", sensor.listen, "the sensor's address towards the controller")
      .with_default();
  tool.option("--controller", sensor.peer, "the controller's address").with_default();
  tool.output("--out", out, "folder for the controller's report.html, SVG and CSV",
              {"report.html", "teleop.json", "live.csv"});
  tool.check([&] {
    if (role == "sensor") expect_addresses(identifier.listen, identifier.peer);
    expect_addresses(sensor.listen, sensor.peer);
  });
  const SeedFlag seed_flag(tool);

  return tool.run(argc, argv, [&] {
    TeleopConfig config =
        parse_teleop(config_path.empty() ? Json::object() : read_json(config_path, Exit::kUsage),
                     config_path.string());
    if (seconds > 0.0) config.duration_s = seconds;
    const PacketKey key = read_packet_key(key_file);
    const std::uint64_t seed = seed_flag.value();
    if (role == "sensor") {
      const Json times = run_live_sensor(config, identifier, sensor, key, seed);
      if (tool.common().json) {
        Tool::print(times);
      } else {
        std::cout << live_text(times);
      }
      return Exit::kDone;
    }
    require(!out.empty(), Exit::kUsage, "--out is required for the controller");
    TeleopTrace trace = run_live_controller(config, {sensor.peer, sensor.listen}, key, seed);
    const Json rows = report(config, std::move(trace), out, seed);
    if (tool.common().json)
      Tool::print(rows);
    else
      std::cout << (out / "report.html").string() << "\n";
    return Exit::kDone;
  });
}
