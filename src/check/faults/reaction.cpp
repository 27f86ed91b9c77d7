// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

void reactions(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.is_wrist()) return;
  Reading reading = base;
  reading.force_axes *= -1.0;
  reading.channel = "fx";
  reading.words =
      "the force is the reaction, of the sensor on the tool (or all three axes are mirrored)";
  reading.flag = log.declared.read.force_sign < 0.0 ? "--force-sign 1" : "--force-sign -1";
  out.push_back(reading);
}

}  // namespace

const FaultKind reaction_fault{
    "reaction", true, "declare the sign of forces", "--force-sign -1", nullptr, reactions, true,
    nullptr,    true};

}  // namespace dcnn::check
