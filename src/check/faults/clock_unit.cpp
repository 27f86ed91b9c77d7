// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

void clock_units(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (log.step <= 0.0) return;
  const struct {
    double unit;
    const char* name;
  } kUnits[] = {{1e-3, "milliseconds"}, {1e-6, "microseconds"}, {1e-9, "nanoseconds"}};
  for (const auto& [unit, name] : kUnits) {
    Reading reading = base;
    reading.clock *= unit;
    reading.channel = "t";
    reading.words = std::string("column t is in ") + name + ", not in seconds";
    out.push_back(reading);
  }
}

}  // namespace

const FaultKind clock_unit_fault{
    "clock_unit", true, "write t in seconds", "", nullptr, clock_units, false, nullptr, true};

}  // namespace dcnn::check
