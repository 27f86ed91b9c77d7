#include <unistd.h>

#include <cmath>
#include <iostream>

#include "dcnn/calibration/calibration.h"
#include "dcnn/runtime/realtime.h"
#include "dcnn/runtime/serve.h"
#include "support/interrupt.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-train --online --train train.csv --out m.dcnn\n"
    "  dcnn-run --model m.dcnn --fallback model.json --stdin < log.csv      # rows in, rows out\n"
    "  dcnn-run --make-key secret.key\n"
    "  dcnn-run --model m.dcnn --fallback model.json --calibration c.json \\\n"
    "    --listen 127.0.0.1:5001 --peer 127.0.0.1:5000 --key-file secret.key\n"
    "  dcnn-run --model m.dcnn --rehearse test.csv --json                   # time per cycle\n"
    "\n"
    "Takes the tool's own force off the measured one, sample by sample, and answers with the\n"
    "external force in the robot's frame. States: WARMUP (windows fill, output zero), NETWORK,\n"
    "PHYSICS (the fallback, while the model's input or output cannot be trusted), HOLD (last\n"
    "output), FADE (to zero), FAULT (latched; a sample with rearm ends it). The output is finite,\n"
    "bounded and slew-limited in all of them. docs/run.md has packets, lines and triggers. The\n"
    "toolkit is no medical device.";

bool is_simulator(const std::filesystem::path& path) { return path.extension() == ".json"; }

Eigen::Matrix3d mounting_of(const FeatureLayout& layout) {
  ToolModel model;
  model.sensor_rotation_rpy = layout.spec.sensor_rotation_rpy;
  return model.R_ES();
}

Simulator read_fallback(const std::filesystem::path& path, bool drifts, const Tool& tool) {
  const Simulator simulator = read_simulator(path);
  if (!drifts) return simulator;
  std::vector<std::string> left_out;
  Simulator part = online_part(simulator, left_out);
  for (const auto& name : left_out) {
    tool.note(path.string() + ": effect '" + name + "' is left to the bias tracker");
  }
  return part;
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-run",
            "Online compensation of the tool's force: pose and force in, external "
            "force out.",
            kExamples);
  std::filesystem::path model, fallback, calibration, key_file, make_key, rehearsal;
  CompensatorOptions options;
  ServeOptions serve;
  bool lines = false;
  double contact = 0.0, hours = 0.025;
  int priority = 0;
  tool.option("--model", model, "trained with --online (.dcnn), or a simulator (.json)");
  tool.option("--fallback", fallback, "simulator that steps in for the model (model.json)");
  tool.option("--calibration", calibration, "sensor frame to robot frame (dcnn-calibrate)");
  auto in = tool.flag("--stdin", lines, "rows on standard input, answers on standard output");
  auto listen = tool.option("--listen", serve.listen, "own address, HOST:PORT or PORT (loopback)");
  auto peer = tool.option("--peer", serve.peer, "the robot's address; nobody else is heard");
  auto key = tool.option("--key-file", key_file, "32 secret bytes that both ends hold");
  tool.option("--make-key", make_key, "write a new key (mode 0600) and end");
  tool.option("--average", options.average, "weighted mean of so many force readings")
      .between(1, 16);
  tool.option("--track-bias", options.bias_seconds,
              "track the sensor's offset with this time constant [s], frozen in contact")
      .positive();
  auto contact_option = tool.option("--contact", contact,
                                    "contact threshold [N] (default: the "
                                    "model's, 1 false alarm an hour)")
                            .positive();
  tool.option("--limit", options.guard.force_n, "most force put out, per axis [N]")
      .positive()
      .with_default();
  tool.option("--slew", options.guard.slew_n, "most change of it, per axis and sample [N]")
      .positive()
      .with_default();
  tool.option("--disagreement", options.guard.disagreement_n,
              "most difference between model and fallback, per axis [N]")
      .positive()
      .with_default();
  tool.option("--seconds", serve.seconds, "end after so long (default: run until killed)")
      .positive();
  tool.option("--late", serve.latest, "most that a packet may come later than the fastest [s]")
      .positive()
      .with_default();
  tool.option("--realtime", priority, "lock memory and run at this SCHED_FIFO priority")
      .between(1, 99);
  auto rehearse_option = tool.option("--rehearse", rehearsal,
                                     "play a recording to itself as "
                                     "fast as it goes; times, states, memory");
  tool.option("--hours", hours, "simulated hours of the rehearsal")
      .positive()
      .needs(rehearse_option)
      .with_default();
  const PrecisionFlag precision(tool);
  listen.needs(peer).needs(key);
  peer.needs(listen);
  key.needs(listen);
  in.excludes(listen).excludes(rehearse_option);
  listen.excludes(rehearse_option);

  return tool.run(argc, argv, [&] {
    if (!make_key.empty()) {
      make_packet_key(make_key);
      return Exit::kDone;
    }
    require(!model.empty(), Exit::kUsage, "--model is required; see dcnn-run --help");
    require(lines || !serve.listen.empty() || !rehearsal.empty(), Exit::kUsage,
            "give --stdin, --listen with --peer and --key-file, or --rehearse");
    if (!key_file.empty()) serve.key = read_packet_key(key_file);
    if (!calibration.empty()) options.R_ES = read_calibration(calibration).R_ES;
    if (contact_option.given()) options.contact_n = contact;
    const bool drifts = options.bias_seconds > 0.0;
    std::optional<Identifier> identifier;
    std::optional<Simulator> physics;
    if (is_simulator(model)) {
      require(fallback.empty(), Exit::kUsage, "--fallback steps in for a trained model; ",
              model.string(), " is a simulator itself");
      require(precision.value() == Precision::kSingle, Exit::kUsage,
              "--precision int16 is for a trained model; ", model.string(), " is a simulator");
      physics = read_fallback(model, drifts, tool);
    } else {
      identifier = read_identifier(model, precision.value());
      if (!fallback.empty())
        physics = read_fallback(fallback, drifts, tool);
      else if (identifier->base)
        physics = identifier->base;
    }
    if (calibration.empty()) {
      options.R_ES = physics ? physics->model.R_ES() : mounting_of(identifier->layout);
    }
    OnlineCompensator compensator(identifier ? &*identifier : nullptr,
                                  physics ? &*physics : nullptr, options, model.string());
    if (!compensator.has_fallback()) {
      tool.note("no --fallback: where the model cannot be trusted the output is held, then faded");
    }
    if (identifier && !compensator.has_envelope()) {
      tool.note(model.string() +
                ": has no envelope of training, unusual motion is not noticed; "
                "train it again with --online");
    }
    if (priority > 0) become_realtime(priority);
    if (lines) {
      const Json report = serve_lines(compensator, STDIN_FILENO, STDOUT_FILENO);
      if (tool.common().json) tool.note(report.dump());
      return Exit::kDone;
    }
    Json report;
    if (rehearsal.empty()) {
      catch_interrupts();
      serve.stop = interrupted;
      report = serve_udp(compensator, serve);
    } else {
      report =
          rehearse(compensator, read_recording(rehearsal, {}, System()),
                   static_cast<std::uint64_t>(std::llround(hours * 3600.0 / compensator.dt())));
    }
    Tool::print(report);
    if (interrupted()) {
      std::cout.flush();
      die_of_interrupt();
    }
    return Exit::kDone;
  });
}
