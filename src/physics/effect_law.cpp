#include "physics/effect_law.h"

#include <cmath>

namespace dcnn {
namespace {

/// A unit axis of B, S or the tool, as seen in S.
Eigen::MatrixXd direction(const std::string& axis, const Motion& motion) {
  const Index i = axis_index(axis);
  Eigen::MatrixXd n = Eigen::MatrixXd::Zero(motion.samples(), 3);
  if (!axis.starts_with("base_")) {
    n.col(i).setOnes();
    return n;
  }
  for (Index k = 0; k < n.rows(); ++k) n.row(k) = motion.R_BS[static_cast<std::size_t>(k)].row(i);
  return n;
}

}  // namespace

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
  wrench.force += factor * offset.force.transpose();
  if (wrench.torque.rows() > 0) wrench.torque += factor * offset.torque.transpose();
}

Line line_of(const std::string& axis, const Motion& motion) {
  if (axis.starts_with("w_sensor_")) {
    return {direction(axis, motion), motion.w_S.col(axis_index(axis))};
  }
  require(motion.v_B.rows() == motion.samples(), Exit::kData, motion.recording,
          ": a force against the velocity along ", axis, " needs columns x,y,z or vx,vy,vz");
  Line line{direction(axis, motion), Eigen::VectorXd(motion.samples())};
  for (Index k = 0; k < motion.samples(); ++k) {
    const Eigen::RowVector3d n_B =
        line.n_S.row(k) * motion.R_BS[static_cast<std::size_t>(k)].transpose();
    line.velocity(k) = n_B.dot(motion.v_B.row(k));
  }
  return line;
}

AngleLine angle_line_of(const std::string& axis, const Motion& motion) {
  const auto colon = axis.find(':');
  const std::string angle = axis.substr(0, colon);
  const Index column = angle == "alpha" ? 0 : angle == "beta" ? 1 : 2;
  return {motion.euler.col(column), direction(axis.substr(colon + 1), motion)};
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
