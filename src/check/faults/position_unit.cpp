// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

void position_units(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.has_all(kPosition)) return;
  const auto add = [&](double factor, const char* words, const char* flag) {
    Reading reading = base;
    reading.position *= factor;
    reading.channel = "x";
    reading.words = words;
    reading.flag = flag;
    out.push_back(reading);
  };
  if (base.position == 1.0) {
    add(1e-3, "positions are in millimetres, not in metres", "--position-unit mm");
    add(1e-2, "positions are in centimetres, not in metres", "");
  } else {
    add(1.0 / base.position, "positions are in metres, not in the unit declared",
        "--position-unit m");
  }
}

}  // namespace

const FaultKind position_unit_fault{
    "position_unit", true, "declare the unit of x, y, z", "", nullptr, position_units, false,
    nullptr,         true};

}  // namespace dcnn::check
