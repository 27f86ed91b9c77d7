#include "check/kind.h"

namespace dcnn::check {
namespace {

void compensations(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.is_wrist() || base.compensated) return;
  Reading reading = base;
  // Who declared no tool may have mounted none.
  reading.harmless = !log.declared.model;
  reading.compensated = true;
  reading.channel = "fx";
  reading.words =
      "the force holds no weight: the controller has subtracted a payload, or no tool is mounted";
  out.push_back(reading);
}

}  // namespace

const FaultKind compensated_fault{
    "compensated",
    true,
    "record with the payload set to 0 kg, or say its mass, which is then added back",
    "--payload KG",
    nullptr,
    compensations,
    true};

}  // namespace dcnn::check
