// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

#include <cmath>

namespace dcnn {
double parameter(Options& parameters, const std::string& key, double low, double high) {
  const auto value = parameters.get<double>(key);
  if (!std::isfinite(value)) parameters.reject(key, "must be finite");
  if (low == kTiny && value <= 0.0) parameters.reject(key, "must be above 0, not ", value);
  return parameters.number(key, value, low, high);
}

Eigen::Vector3d parameters3(Options& parameters, const std::string& stem,
                            const std::string& suffix) {
  Eigen::Vector3d values;
  for (Index i = 0; i < 3; ++i) {
    values(i) = parameter(parameters, stem + "_" + "xyz"[i] + suffix);
  }
  return values;
}

Offset read_offset(Options& parameters, const std::string& stem, const std::string& per) {
  Offset offset{parameters3(parameters, stem, "_n" + per), Eigen::Vector3d::Zero()};
  for (Index i = 0; i < 3; ++i) {
    offset.torque(i) =
        parameters.number(stem + "_t" + "xyz"[i] + "_nm" + per, 0.0, -kInfinity, kInfinity);
  }
  return offset;
}

Json offset_parameters(const Eigen::VectorXd& amplitudes, const std::string& stem,
                       const std::string& per) {
  Json parameters;
  for (Index i = 0; i < amplitudes.size(); ++i) {
    const std::string axis(1, "xyz"[i % 3]);
    parameters[i < 3 ? stem + "_" + axis + "_n" + per : stem + "_t" + axis + "_nm" + per] =
        amplitudes(i);
  }
  return parameters;
}

void add(Wrench& wrench, const Offset& offset, const Eigen::VectorXd& factor) {
  for (Index c = 0; c < 3; ++c) {
    if (offset.force(c) != 0.0) wrench.force.col(c) += offset.force(c) * factor;
    if (wrench.torque.rows() > 0 && offset.torque(c) != 0.0) {
      wrench.torque.col(c) += offset.torque(c) * factor;
    }
  }
}

Eigen::MatrixXd direction_of(const std::string& axis, const Motion& motion) {
  Wrench unit{Eigen::MatrixXd::Zero(motion.samples(), 3), {}};
  push_along(axis, motion, Eigen::VectorXd::Ones(motion.samples()), unit);
  return unit.force;
}

void push_along(const std::string& axis, const Motion& motion, const Eigen::VectorXd& force,
                Wrench& wrench) {
  const Index i = axis_index(axis);
  if (!axis.starts_with("base_")) {
    wrench.force.col(i) += force;
    return;
  }
  for (Index k = 0; k < force.size(); ++k) {
    const Eigen::Matrix3d& R_BS = motion.R_BS[static_cast<std::size_t>(k)];
    for (Index c = 0; c < 3; ++c) wrench.force(k, c) += force(k) * R_BS(i, c);
  }
}

void add_moment(const Eigen::Vector3d& lever, const Eigen::MatrixXd& before, Wrench& wrench) {
  for (Index k = 0; k < wrench.torque.rows(); ++k) {
    const Eigen::Vector3d added = wrench.force.row(k) - before.row(k);
    wrench.torque.row(k) += lever.cross(added).transpose();
  }
}

Eigen::VectorXd velocity_of(const std::string& axis, const Motion& motion) {
  const Index i = axis_index(axis);
  if (axis.starts_with("w_sensor_")) return motion.w_S.col(i);
  require(motion.v_B.rows() == motion.samples(), Exit::kData, motion.recording,
          ": a force against the velocity along ", axis, " needs columns x,y,z or vx,vy,vz");
  if (axis.starts_with("base_")) return motion.v_B.col(i);
  Eigen::VectorXd velocity(motion.samples());
  for (Index k = 0; k < velocity.size(); ++k) {
    const Eigen::Matrix3d& R_BS = motion.R_BS[static_cast<std::size_t>(k)];
    velocity(k) = motion.v_B(k, 0) * R_BS(0, i) + motion.v_B(k, 1) * R_BS(1, i) +
                  motion.v_B(k, 2) * R_BS(2, i);
  }
  return velocity;
}

AngleAxis angle_axis(const std::string& axis) {
  return {axis.starts_with("alpha")  ? 0
          : axis.starts_with("beta") ? 1
                                     : 2,
          axis.substr(axis.find(':') + 1)};
}

Index axis_index(const std::string& axis) { return axis.back() - 'x'; }

Eigen::MatrixXd felt_acceleration(const ToolModel& model, const Motion& motion) {
  const bool moving = model.inertial != ToolModel::Inertial::kNone;
  require(!moving || motion.a_B.rows() == motion.samples(), Exit::kData, motion.recording,
          ": the inertial force needs columns x,y,z or ax,ay,az; log them, or set model.inertial "
          "to none");
  Eigen::MatrixXd felt(motion.samples(), 3);
  for (Index k = 0; k < motion.samples(); ++k) {
    Eigen::RowVector3d field = model.gravity.transpose();
    if (moving) field -= motion.a_B.row(k);
    felt.row(k) = field * motion.R_BS[static_cast<std::size_t>(k)];
  }
  return felt;
}

}  // namespace dcnn
