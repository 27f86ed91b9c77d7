// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

using Eigen::Vector3d;

/// An arm that hangs from a ceiling or a wall.
void gravity_directions(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (log.arm.empty() || base.compensated) return;
  const Vector3d told = (base.arm.gravity * log.declared.arm->gravity).normalized();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Vector3d down = sign * Vector3d::Unit(axis);
      if (down.dot(told) > 0.99) continue;
      Reading reading = base;
      reading.arm.gravity =
          Eigen::Quaterniond::FromTwoVectors(told, down).toRotationMatrix() * base.arm.gravity;
      reading.words = std::string("gravity points along ") + (sign > 0.0 ? "+" : "-") +
                      std::string(1, "xyz"[axis]) +
                      " of the arm's base, not as described: it hangs from a wall or a ceiling";
      out.push_back(std::move(reading));
    }
  }
}

}  // namespace

const FaultKind gravity_direction_fault{
    "gravity_direction",
    true,
    "say how the base is mounted: arm.gravity_mps2 of the system's description, or a fixed joint "
    "before the URDF's first",
    "",
    nullptr,
    gravity_directions,
    true};

}  // namespace dcnn::check
