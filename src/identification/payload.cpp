// SPDX-License-Identifier: Apache-2.0
#include "dcnn/identification/payload.h"

#include "core/linear_algebra.h"

namespace dcnn {

PayloadBody payload_of(const ToolModel& model) {
  const Eigen::Matrix3d R_ES = model.R_ES();
  PayloadBody payload;
  payload.mass = model.mass;
  payload.com = R_ES * model.com;
  if (model.inertia) {
    const Eigen::Vector3d& c = payload.com;
    const Eigen::Matrix3d about_origin = R_ES * *model.inertia * R_ES.transpose();
    const Eigen::Matrix3d steiner =
        model.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
    payload.inertia_com = about_origin - steiner;
  }
  return payload;
}

Eigen::Vector3d PayloadBody::moments() const {
  if (!inertia_com) return Eigen::Vector3d::Zero();
  return spectrum_of(*inertia_com).values;
}

Eigen::Matrix3d PayloadBody::axes() const {
  if (!inertia_com) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d axes = spectrum_of(*inertia_com).vectors;
  if (axes.determinant() < 0.0) axes.col(0) = -axes.col(0);
  return axes;
}

}  // namespace dcnn
