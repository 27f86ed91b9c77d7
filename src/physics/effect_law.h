// SPDX-License-Identifier: Apache-2.0
// What the laws in effects/ share: their names, their parameters, and the axes they act along.
#pragma once

#include <limits>
#include <string>

#include "dcnn/physics/effect.h"
#include "physics/found_numbers.h"

namespace dcnn {

#define EFFECT(id)                \
  namespace effects::id {         \
  extern const EffectKind effect; \
  }
#include "physics/effects.def"
#undef EFFECT

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTiny = std::numeric_limits<double>::min();  ///< the least positive number
/// EffectKind::hidden_by of what changes the simulator's tool.
inline constexpr const char* kUnknownTool = "the simulator's own tool is not known";

/// EffectKind::hidden_by of forces over the position: of a second encoder or a gyroscope beside the
/// motion that a simulator gives it they are no physics, but what a delay makes of one frequency.
inline const char* no_force_on_a_motion(const Showing& of) {
  return of.reads_motion && !of.fitted_base ? "what is read is a motion, on which no force acts"
                                            : nullptr;
}

/// A parameter that must be there: a finite number in [low, high].
double parameter(Options& parameters, const std::string& key, double low = -kInfinity,
                 double high = kInfinity);

/// The three parameters <stem>_x<suffix>, _y, _z.
Eigen::Vector3d parameters3(Options& parameters, const std::string& stem,
                            const std::string& suffix);

/// A constant force and torque: <stem>_x_n…, and on torques the optional <stem>_tx_nm…
/// `per` follows the unit, as in rate_x_nps and rate_tx_nmps.
struct Offset {
  Eigen::Vector3d force, torque;
  bool is_zero() const { return force.isZero(0.0) && torque.isZero(0.0); }
};
Offset read_offset(Options& parameters, const std::string& stem, const std::string& per = "");

/// The parameters read_offset() reads, from 3 amplitudes or 6 with torques.
Json offset_parameters(const Eigen::VectorXd& amplitudes, const std::string& stem,
                       const std::string& per = "");

/// Adds factor_k·offset to each row k.
void add(Wrench& wrench, const Offset& offset, const Eigen::VectorXd& factor);

/// A unit axis n of B, S or the tool, as seen in S at each sample, (T,3).
Eigen::MatrixXd direction_of(const std::string& axis, const Motion& motion);
/// Adds force_k n to the force of each sample k.
void push_along(const std::string& axis, const Motion& motion, const Eigen::VectorXd& force,
                Wrench& wrench);

/// Adds the torque at `lever` [m, in S] of the force that is beyond `before`.
void add_moment(const Eigen::Vector3d& lever, const Eigen::MatrixXd& before, Wrench& wrench);

/// For tool_z, base_* and w_sensor_*: of the sensor's origin along n, m/s; about n for w_sensor_*,
/// rad/s. Error(kData) where the motion lacks it.
Eigen::VectorXd velocity_of(const std::string& axis, const Motion& motion);

/// Of <angle>:<axis>: which angle, and along what it pushes.
struct AngleAxis {
  Index angle;  ///< column of Motion::euler
  std::string axis;
};
AngleAxis angle_axis(const std::string& axis);

/// 0, 1, 2 for an axis that ends in x, y, z.
Index axis_index(const std::string& axis);

/// Time from sample k - 1 to k, s.
inline double step(const Motion& motion, Index k) { return motion.t(k) - motion.t(k - 1); }

/// A unit axis of B, S or the tool, and what moves along or about it, at one sample.
class LineNow {
 public:
  explicit LineNow(const std::string& axis)
      : index_(axis_index(axis)),
        base_(axis.starts_with("base_")),
        turns_(axis.starts_with("w_")) {}
  Eigen::Vector3d n_S(const Instant& now) const {
    if (base_) return now.R_BS.row(index_).transpose();
    return Eigen::Vector3d::Unit(index_);
  }
  double velocity(const Instant& now) const {
    return turns_ ? now.w_S[index_] : (now.R_BS * n_S(now)).dot(now.v_B);
  }
  double acceleration(const Instant& now) const {
    return turns_ ? now.dw_S[index_] : (now.R_BS * n_S(now)).dot(now.a_B);
  }

 private:
  Index index_;
  bool base_, turns_;
};

/// <angle>:<axis> at one sample.
struct AngleNow {
  explicit AngleNow(const std::string& axis)
      : angle(angle_axis(axis).angle), line(angle_axis(axis).axis) {}
  Index angle;
  LineNow line;
};

/// EffectKind::apply and ::stream of a force law(angle)·n.
template <auto law>
void pushed(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
            Options& parameters) {
  const AngleAxis at = angle_axis(spec.axis);
  push_along(at.axis, motion, motion.euler.col(at.angle).unaryExpr(law(parameters)), wrench);
}
template <auto law>
EffectStream pushing(const EffectSpec& spec, Options& parameters) {
  return [at = AngleNow(spec.axis), law_of_q = law(parameters)](InstantWrench& wrench,
                                                                const Instant& now) {
    wrench.force += law_of_q(now.euler[at.angle]) * at.line.n_S(now);
  };
}

/// R^T (g - a_o), (T,3): the acceleration field that the tool feels, in S.
Eigen::MatrixXd felt_acceleration(const ToolModel& model, const Motion& motion);

}  // namespace dcnn
