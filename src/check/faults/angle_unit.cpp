// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numbers>

#include "check/kind.h"

namespace dcnn::check {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

void angle_units(const Log& log, const Reading& base, std::vector<Reading>& out) {
  const bool wrist = log.has_all(kEuler) && !log.has_quaternion();
  if (!wrist && log.joints.empty()) return;
  const bool radians = base.angle == 1.0;
  Reading reading = base;
  reading.angle = reading.rate = radians ? kDegree : 1.0;
  reading.channel = wrist ? "alpha" : log.joints[0].position;
  reading.words = radians ? "angles are in degrees, not in radians"
                          : "angles are in radians, not in the unit declared";
  if (wrist) reading.flag = radians ? "--angle-unit deg" : "--angle-unit rad";
  out.push_back(reading);
  const bool rates = std::any_of(log.joints.begin(), log.joints.end(),
                                 [](const Joint& joint) { return !joint.velocity.empty(); });
  if (wrist || !radians || !rates) return;
  reading.rate = 1.0;
  reading.words = "angles are in degrees beside rates in radians per second";
  out.push_back(reading);
}

}  // namespace

const FaultKind angle_unit_fault{
    "angle_unit", true,    "declare the unit of the angles, or write radians",
    "",           nullptr, angle_units,
    false,        nullptr, true};

}  // namespace dcnn::check
