// SPDX-License-Identifier: Apache-2.0
#include "conceal/world.h"

#include <algorithm>
#include <cmath>

#include "conceal/laws.h"
#include "dcnn/data/rotation.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;

/// Tool and gravity as they are.
Eigen::Vector3d apply_parameters(const std::vector<Hidden>& hidden, Tool& tool) {
  Eigen::Vector3d gravity = kGravity;
  for (const Hidden& h : hidden) {
    const Parameters& p = h.parameters;
    if (h.effect == "inertial_terms") tool.inertial = "full";
    if (h.effect == "mass") tool.mass += p.at("delta_mass_kg");
    if (h.effect == "com") {
      tool.com +=
          Eigen::Vector3d(p.at("delta_com_x_m"), p.at("delta_com_y_m"), p.at("delta_com_z_m"));
    }
    if (h.effect == "gravity_tilt") {
      gravity = rotation_from_euler({0.0, p.at("tilt_y_rad"), p.at("tilt_x_rad")}) * gravity;
    }
  }
  return gravity;
}

int stage(const Hidden& h) {
  if (h.effect == "flexible_resonance" || h.effect == "two_modes") return 0;
  if (h.effect == "misalignment") return 1;
  if (h.effect == "gain") return 2;
  if (h.effect == "crosstalk") return 3;
  if (h.effect == "lowpass" || h.effect == "creep") return 4;
  return h.effect == "time_delay" ? 5 : 6;
}

Eigen::MatrixXd decimated(const Eigen::MatrixXd& F, int stride) {
  Eigen::MatrixXd out((F.rows() + stride - 1) / stride, F.cols());
  for (Index i = 0; i < out.rows(); ++i) out.row(i) = F.row(i * stride);
  return out;
}

/// What an ideal simulator of the tool says, in the sensor frame.
Eigen::RowVector3d rigid(const Path& path, Index i, const Tool& tool,
                         const Eigen::Vector3d& gravity) {
  const Eigen::Matrix3d& R = path.rotation[static_cast<std::size_t>(i)];
  Eigen::Vector3d a = R.transpose() * gravity;
  if (tool.inertial != "none") a -= R.transpose() * path.acceleration.row(i).transpose();
  if (tool.inertial == "full") {
    const Eigen::Vector3d w = path.rate.row(i), dw = path.rate_derivative.row(i);
    a -= dw.cross(tool.com) + w.cross(w.cross(tool.com));
  }
  return tool.mass * a.transpose();
}

}  // namespace

void digitise(const std::vector<Hidden>& hidden, Eigen::MatrixXd& F) {
  for (const Hidden& h : hidden) {
    if (h.effect == "saturation") {
      const double limit = h.parameters.at("limit_n");
      const Index a = h.axis.back() - 'x';
      F.col(a) = F.col(a).cwiseMax(-limit).cwiseMin(limit);
    }
  }
  for (const Hidden& h : hidden) {
    if (h.effect == "quantisation") {
      const double step = h.parameters.at("step_n");
      auto forces = F.leftCols(std::min<Index>(3, F.cols()));
      forces = (forces / step).array().round().matrix() * step;
    }
  }
}

Eigen::MatrixXd felt_field(const Path& path, const Eigen::Vector3d& gravity) {
  Eigen::MatrixXd field(path.samples(), 3);
  for (Index i = 0; i < field.rows(); ++i) {
    const Eigen::Matrix3d& R = path.rotation[static_cast<std::size_t>(i)];
    field.row(i) = (gravity.transpose() - path.acceleration.row(i)) * R;
  }
  return field;
}

Eigen::MatrixXd force(const Path& path, const Tool& nominal, const std::vector<Hidden>& hidden) {
  Tool tool = nominal;
  const Eigen::Vector3d gravity = apply_parameters(hidden, tool);
  const Eigen::MatrixXd field = felt_field(path, gravity);
  Eigen::MatrixXd F(path.samples(), 3);
  for (Index i = 0; i < F.rows(); ++i) F.row(i) = rigid(path, i, tool, gravity);
  if (path.rigid.rows() > 0) F += path.rigid;
  const Eigen::MatrixXd carried = path.load.rows() > 0 ? path.load : F;
  const bool turns = !nominal.beads.empty();
  Eigen::MatrixXd torque = turns ? rigid_torque(path, nominal, tool, gravity) : Eigen::MatrixXd();
  for (const Hidden& h : hidden) {
    const Eigen::MatrixXd before = F;
    add_force(path, h, field, carried, F);
    if (turns) add_moment(path, h, F - before, torque);
  }
  Eigen::MatrixXd read(F.rows(), turns ? 6 : 3);
  read.leftCols(3) = F;
  if (turns) read.rightCols(3) = torque;
  for (int s = 0; s <= 6; ++s) {
    if (s == 6) read.leftCols(3).rowwise() += tool.bias.transpose();
    if (s == 6 && turns) read.rightCols(3).rowwise() += tool.bias_torque.transpose();
    for (const Hidden& h : hidden) {
      if (stage(h) == s) change_reading(path, h, read);
    }
  }
  return read;
}

Eigen::MatrixXd reading(const Path& path, const Tool& tool, const std::vector<Hidden>& hidden,
                        const Eigen::MatrixXd& noise, int stride) {
  Eigen::MatrixXd out = decimated(force(path, tool, hidden), stride);
  if (noise.rows() == out.rows()) out += noise;
  digitise(hidden, out);
  return out;
}

}  // namespace dcnn::conceal
