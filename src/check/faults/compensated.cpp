#include "check/kind.h"

namespace dcnn::check {
namespace {

void compensated_arm(const Log& log, const Reading& base, std::vector<Reading>& out) {
  Reading reading = base;
  reading.compensated = true;
  reading.channel = log.joints[base.arm.joint[0]].measured;
  reading.words = "the torques hold no weight of the arm: its controller has subtracted it";
  reading.remedy =
      "log the torques before gravity is subtracted, or set arm.gravity_mps2 of the "
      "system's description to 0 0 0";
  out.push_back(std::move(reading));
}

void compensations(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (base.compensated) return;
  if (!log.arm.empty()) return compensated_arm(log, base, out);
  if (!log.is_wrist()) return;
  Reading reading = base;
  // Who declared no tool may have mounted none.
  reading.harmless = !log.declared.model;
  reading.compensated = true;
  reading.channel = "fx";
  reading.flag = "--payload KG";
  reading.words =
      "the force holds no weight: the controller has subtracted a payload, or no tool is mounted";
  out.push_back(reading);
}

}  // namespace

const FaultKind compensated_fault{
    "compensated",
    true,
    "record with the payload set to 0 kg, or say its mass, which is then added back",
    "",
    nullptr,
    compensations,
    true};

}  // namespace dcnn::check
