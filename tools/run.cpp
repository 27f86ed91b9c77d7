// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cmath>
#include <iostream>

#include "dcnn/runtime/open.h"
#include "dcnn/runtime/realtime.h"
#include "dcnn/runtime/serve.h"
#include "support/interrupt.h"
#include "support/recipe_option.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-train --online --train train.csv --out m.dcnn\n"
    "  dcnn-run --model m.dcnn --fallback model.json --stdin < log.csv      # rows in, rows out\n"
    "  dcnn-run --make-key secret.key\n"
    "  dcnn-run --model m.dcnn --fallback model.json --calibration c.json \\\n"
    "    --listen 127.0.0.1:5001 --peer 127.0.0.1:5000 --key-file secret.key --plot 9870\n"
    "  dcnn-run --model m.dcnn --rehearse test.csv --json                   # time per cycle\n"
    "\n"
    "Takes the tool's own force off the measured one, sample by sample, and answers with the\n"
    "external force in the robot's frame. States: WARMUP (windows fill, output zero), NETWORK,\n"
    "PHYSICS (the fallback, while the model's input or output cannot be trusted), HOLD (last\n"
    "output), FADE (to zero), FAULT (latched; a sample with rearm ends it). The output is finite,\n"
    "bounded and slew-limited in all of them. docs/use/run.md has packets, lines and triggers. "
    "The\n"
    "toolkit is no medical device.";

/// HOST:PORT of what may be PORT alone, which is on the loopback.
std::string with_host(const std::string& address) {
  return address.find(':') == std::string::npos ? "127.0.0.1:" + address : address;
}

std::string listening(const ServeOptions& serve) {
  return "listening    " + with_host(serve.listen) + " (UDP), for packets of " +
         with_host(serve.peer) + (serve.seconds > 0.0 ? "" : "; Ctrl-C ends it");
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-run",
            "Online compensation of the tool's force: pose and force in, external "
            "force out.",
            kExamples);
  OnlineFiles files;
  std::filesystem::path key_file, make_key, rehearsal;
  std::string plot;
  CompensatorOptions options;
  ServeOptions serve;
  bool lines = false;
  double contact = 0.0, hours = 0.025;
  int priority = 0;
  tool.option("--model", files.model, "trained with --online (.dcnn), or a simulator (.json)")
      .holds({FileKind::kModel, FileKind::kSimulator});
  tool.option("--fallback", files.fallback, "simulator that steps in for the model (model.json)")
      .holds({FileKind::kSimulator});
  tool.option("--calibration", files.calibration, "sensor frame to robot frame (dcnn-calibrate)")
      .holds({FileKind::kCalibration});
  auto in = tool.flag("--stdin", lines, "rows on standard input, answers on standard output");
  auto listen = tool.option("--listen", serve.listen, "own address, HOST:PORT or PORT (loopback)");
  auto peer = tool.option("--peer", serve.peer, "the robot's address; nobody else is heard");
  auto key = tool.option("--key-file", key_file, "32 secret bytes that both ends hold");
  tool.output("--make-key", make_key, "write a new key (mode 0600) and end").precious();
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
                                     "fast as it goes; times, states, memory")
                             .holds({FileKind::kRecording});
  std::optional<std::filesystem::path> recipe;
  add_recipe_option(tool, recipe).needs(rehearse_option);
  UnitFlags units(tool);  // packets are in SI units
  units.exclude(listen);
  tool.option("--hours", hours, "simulated hours of the rehearsal")
      .positive(10000)
      .needs(rehearse_option)
      .with_default();
  tool.option("--plot", plot,
              "send every cycle as JSON by UDP to this PORT or HOST:PORT, for PlotJuggler")
      .called("PORT")
      .excludes(rehearse_option);
  const PrecisionFlag precision(tool);
  listen.needs(peer).needs(key);
  peer.needs(listen);
  key.needs(listen);
  in.excludes(listen).excludes(rehearse_option);
  listen.excludes(rehearse_option);

  tool.check([&] {
    require(!is_standard_output(make_key), Exit::kUsage,
            "--make-key makes a file that its owner alone may read, and - is standard output; name "
            "a file");
  });

  return tool.run(argc, argv, [&] {
    if (!make_key.empty()) {
      make_packet_key(make_key);
      if (tool.common().json) Tool::print({{"key_file", make_key.string()}});
      return Exit::kDone;
    }
    require(!files.model.empty(), Exit::kUsage, "--model is required; see dcnn-run --help");
    require(lines || !serve.listen.empty() || !rehearsal.empty(), Exit::kUsage,
            "give --stdin, --listen with --peer and --key-file, or --rehearse");
    if (!key_file.empty()) serve.key = read_packet_key(key_file);
    if (contact_option.given()) options.contact_n = contact;
    files.precision = precision.value();
    OnlineCompensator compensator =
        open_compensator(files, options, [&](const std::string& text) { tool.note(text); });
    std::optional<PlotStream> stream;  // before real time: its thread keeps the usual priority
    if (!plot.empty()) serve.plot = &stream.emplace(plot, compensator.has_torque());
    if (priority > 0) become_realtime(priority);
    const ReadOptions read = units.options();
    if (lines) {
      const Json report = serve_lines(compensator, STDIN_FILENO, STDOUT_FILENO, read, serve.plot);
      const std::string idle = warmup_text(report);
      if (tool.common().json) {
        tool.note(report.dump());
      } else if (!idle.empty()) {
        tool.note(idle);
      }
      return Exit::kDone;
    }
    Json report;
    if (recipe) read_by_recipe(*recipe);
    if (rehearsal.empty()) {
      catch_interrupts();
      bool is_told = false;
      serve.stop = [&] {  // asked first when the address is had and nothing has been received
        if (!is_told) tool.note(listening(serve));
        is_told = true;
        return interrupted();
      };
      report = serve_udp(compensator, serve);
    } else {
      report =
          rehearse(compensator, read_recording(rehearsal, read, System()),
                   static_cast<std::uint64_t>(std::llround(hours * 3600.0 / compensator.dt())));
    }
    if (tool.common().json) {
      Tool::print(report);
    } else {
      std::cout << cycles_text(report);
    }
    if (interrupted()) {
      std::cout.flush();
      die_of_interrupt();
    }
    return Exit::kDone;
  });
}
