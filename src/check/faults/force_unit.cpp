// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

void force_units(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.is_wrist()) return;
  const struct {
    double unit;
    const char* name;
  } kUnits[] = {{1e-3, "millinewtons"},
                {9.80665, "kilograms (kgf)"},
                {9.80665e-3, "grams (gf)"},
                {4.4482216, "pounds (lbf)"}};
  for (const auto& [unit, name] : kUnits) {
    Reading reading = base;
    reading.force *= unit;
    reading.channel = "fx";
    reading.words = std::string("forces are in ") + name + ", not in newtons";
    out.push_back(reading);
  }
}

}  // namespace

const FaultKind force_unit_fault{
    "force_unit", true, "write forces in newtons", "", nullptr, force_units, true, nullptr, true};

}  // namespace dcnn::check
