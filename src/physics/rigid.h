// SPDX-License-Identifier: Apache-2.0
// The rigid body at one sample.
#pragma once

#include "dcnn/physics/effect.h"

namespace dcnn {

/// Force and torque of the tool without the sensor's bias; `field` is R^T (g - a_o), what the tool
/// feels, in S. No torque without an inertia.
inline InstantWrench rigid_at(const ToolModel& model, const Eigen::Vector3d& field,
                              const Eigen::Vector3d& w, const Eigen::Vector3d& dw) {
  const bool full = model.inertial == ToolModel::Inertial::kFull;
  const Eigen::Vector3d& c = model.com;
  InstantWrench wrench;
  Eigen::Vector3d at_com = field;
  if (full) at_com -= dw.cross(c) + w.cross(w.cross(c));
  wrench.force = model.mass * at_com;
  if (!model.inertia) return wrench;
  wrench.torque = c.cross(model.mass * field);
  if (full) wrench.torque -= *model.inertia * dw + w.cross(*model.inertia * w);
  return wrench;
}

}  // namespace dcnn
