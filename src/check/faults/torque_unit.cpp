// SPDX-License-Identifier: Apache-2.0
#include "check/arm.h"
#include "check/kind.h"
#include "dcnn/core/number.h"

namespace dcnn::check {
namespace {

constexpr double kNearOne = 2.0;  // factors that drives' constants may be wrong by

/// Currents, counts, torques of the motors before the gears: a factor for each joint.
void add_factors(const Log& log, const Reading& base, std::vector<Reading>& out) {
  const auto factors = torque_factors(log, base);
  if (!factors || !factors->allFinite()) return;
  Reading reading = base;
  reading.arm.torque = reading.arm.torque.cwiseProduct(*factors);
  reading.estimated = static_cast<int>(factors->size());
  reading.harmless = factors->maxCoeff() < kNearOne && factors->minCoeff() > 1.0 / kNearOne;
  reading.words =
      "torques are no torques of the joints in N·m (currents, counts, motors before "
      "their gears?): the links described ask for these factors, from the base on:";
  for (const double factor : *factors) reading.words += " " + brief(factor);
  out.push_back(std::move(reading));
}

void torque_units(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (log.arm.empty()) return;
  const struct {
    double unit;
    const char* name;
  } kUnits[] = {{1e-3, "millinewton metres"},
                {1e-2, "newton centimetres"},
                {9.80665, "kilogram metres (kgf m)"},
                {9.80665e-2, "kilogram centimetres (kgf cm)"}};
  for (const auto& [unit, name] : kUnits) {
    Reading reading = base;
    reading.arm.torque *= unit;
    reading.words = std::string("torques are in ") + name + ", not in newton metres";
    out.push_back(std::move(reading));
  }
  add_factors(log, base, out);
  for (Reading& reading : out) reading.channel = log.joints[base.arm.joint[0]].measured;
}

}  // namespace

const FaultKind torque_unit_fault{"torque_unit",
                                  true,
                                  "give each axis its scale in --system, or write newton metres",
                                  "",
                                  nullptr,
                                  torque_units,
                                  true};

}  // namespace dcnn::check
