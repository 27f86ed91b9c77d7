// SPDX-License-Identifier: Apache-2.0
// The reports of loops in words.
#include "dcnn/core/number.h"
#include "dcnn/runtime/serve.h"

namespace dcnn {
namespace {

std::string milli_or_micro(double seconds) {
  return seconds < 1e-3 ? brief(1e6 * seconds) + " µs" : brief(1e3 * seconds) + " ms";
}

}  // namespace

std::string counts_text(const Json& counts) {
  std::string text;
  for (const auto& [name, count] : counts.items()) {
    if (count.get<std::uint64_t>() == 0) continue;
    text += (text.empty() ? "" : ", ") + count.dump() + " " + name;
  }
  return text.empty() ? "none" : text;
}

std::string times_text(const Json& times) {
  std::string text;
  for (const auto& [name, key] : {std::pair{"p50", "p50_s"}, std::pair{"p99", "p99_s"},
                                  std::pair{"p99.9", "p999_s"}, std::pair{"most", "max_s"}}) {
    text += (text.empty() ? "" : ", ") + std::string(name) + " " +
            milli_or_micro(times[key].get<double>());
  }
  return text;
}

std::string warmup_text(const Json& report) {
  std::uint64_t warming = 0, others = 0;
  for (const auto& [state, count] : report["states"].items()) {
    (state == "WARMUP" ? warming : others) += count.get<std::uint64_t>();
  }
  if (warming == 0 || others > 0) return "";
  return "nothing was compensated: all " + std::to_string(warming) + " cycles in WARMUP (" +
         counts_text(report["reasons"]) +
         "); envelope: poses beyond those of the training, or not in m, rad and N; model: fewer "
         "rows than the derivative's window";
}

std::string cycles_text(const Json& report) {
  std::string text = "cycles      " + counts_text(report["states"]) + "\n";
  if (!report["reasons"].empty()) text += "reasons     " + counts_text(report["reasons"]) + "\n";
  text += "contact     in " + report["contact_cycles"].dump() + " cycles; " +
          report["missed_cycles"].dump() + " missed, " + report["overruns"].dump() + " overrun\n" +
          "time        " + times_text(report["cpu"]) + " of processor time a cycle\n";
  if (report.contains("packets")) {
    text += "packets     " + counts_text(report["packets"]) + "\n";
  }
  if (report.contains("hours")) {
    text += "rehearsed   " + brief(report["hours"].get<double>()) + " h; " +
            report["envelope_alarms"].dump() + " alarms of the envelope, memory grew by " +
            brief(report["memory_growth_bytes"].get<double>() / 1024.0) + " KiB\n";
  }
  return text;
}

}  // namespace dcnn
