// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"
#include "dcnn/core/number.h"

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
  reading.prior = 1.0 - kPartly;
  reading.words =
      "the force holds no weight: the controller has subtracted a payload, or no tool is mounted";
  out.push_back(reading);
}

/// Another mass than the tool's was subtracted: its weight and its inertia are of two masses. The
/// inertia tells that of a motion alone.
void partly_compensated(const Fitting& fitting, std::vector<Reading>& out) {
  const auto& [log, rows, motion, base] = fitting;
  if (base.compensated || rows.half == 0 || !motion.has_position) return;
  Reading reading = base;
  reading.harmless = !log.declared.model;
  reading.compensated = reading.weight_apart = true;
  reading.channel = "fx";
  reading.prior = kPartly;
  reading.estimated = 1;
  const RigidFit fit = fit_rigid(log, rows, motion, reading, {0, true});
  reading.flag = "--payload " + brief(fit.mass - fit.weighed);
  reading.words = "the tool weighs " + brief(fit.weighed) + " kg by its weight and " +
                  brief(fit.mass) +
                  " kg by its inertia: the controller has subtracted another payload than the tool";
  out.push_back(std::move(reading));
}

}  // namespace

const FaultKind compensated_fault{
    "compensated",
    true,
    "record with the payload set to 0 kg, or say its mass, which is then added back",
    "",
    nullptr,
    compensations,
    true,
    partly_compensated};

}  // namespace dcnn::check
