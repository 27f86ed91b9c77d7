// SPDX-License-Identifier: Apache-2.0
// A reading: what the numbers of a log mean. The log as declared is one, each fault of units,
// signs, axes, frames and orders is another; they are compared by how well a rigid tool explains
// them.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/check/check.h"

namespace dcnn::check {

/// How three or four columns make R_BE.
struct Orientation {
  std::string order;                    ///< of elementary turns, "zyx"; of a quaternion, "wxyz"
  bool reversed = false;                ///< the first column belongs to the last letter
  bool inverse = false;                 ///< the log holds R_EB
  bool inverse_position = false;        ///< and the base's position in E: x = -R_BE x_logged
  Eigen::Vector3d sign{1.0, 1.0, 1.0};  ///< of the Euler angles

  bool operator==(const Orientation&) const = default;
};

/// How an arm's columns make the angles and torques of the chain described, by joint of the chain:
/// angle = sign · logged + zero.
struct ArmReading {
  std::vector<std::size_t> joint;      ///< whose columns of the log these are
  Eigen::VectorXd sign, zero, torque;  ///< zero in rad; torque: described over logged
  Eigen::Matrix3d gravity = Eigen::Matrix3d::Identity();  ///< turn of the one described
};

struct Reading {
  std::string fault, words, channel, flag;  ///< empty as declared
  std::string remedy;                       ///< in place of the kind's
  double prior = 1.0;
  double clock = 1.0, position = 1.0, angle = 1.0, force = 1.0;  ///< SI per unit of the file
  double rate = 1.0;  ///< the same of the rate of a joint that turns
  Orientation orientation;
  Eigen::Matrix3d position_axes = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d force_axes = Eigen::Matrix3d::Identity();  ///< F_S = force_axes * F_log
  ArmReading arm;                                            ///< of Log::arm
  bool force_in_base = false, compensated = false;
  bool weight_apart = false;  ///< beside `compensated`: part of the weight is left
  bool harmless = false;      ///< what one may leave undeclared: it stops nothing
  int estimated = 0;          ///< numbers chosen to suit the log
};

/// What was said of a reading's fault is not said of the next one, which begins from it.
inline void say_nothing(Reading& reading) {
  reading.words.clear(), reading.channel.clear(), reading.flag.clear(), reading.remedy.clear();
  reading.harmless = false;
}

/// Rows of the log on which readings are compared, smoothed over some 0.12 s, with derivatives
/// per sample: units of the clock come later.
struct Sampled {
  std::vector<Eigen::Index> centres;
  Eigen::Index half = 0;  ///< of the window [rows]; 0: single rows of a list of poses
  Eigen::VectorXd value, first, second;  ///< weights of the window
  /// Effective numbers of residuals of the torques of the log's joints, by their correlation;
  /// empty: unknown.
  Eigen::VectorXd independent_torques;

  /// Seconds in so many rows of the log; 0 of poses.
  double seconds(Eigen::Index count) const;
  Eigen::MatrixXd smoothed(const Eigen::MatrixXd& signals, const Eigen::VectorXd& weights,
                           Eigen::Index shift = 0) const;
};
/// No rows where a motion is too short to be differentiated.
Sampled sample(const Log& log);
/// Effective number of residuals of an axis.
double independent_residuals(const Log& log, const Sampled& rows);

/// The motion as one reading has it, per sample.
struct Kinematics {
  std::vector<Eigen::Matrix3d> R;                    ///< R_BE
  Eigen::MatrixXd w, dw;                             ///< (n,3) in E
  Eigen::MatrixXd position, velocity, acceleration;  ///< (n,3) in B; (n,3) zero without a position
  bool has_position = false;
};
Kinematics kinematics(const Log& log, const Sampled& rows, const Reading& reading);

/// R_BE of every row.
std::vector<Eigen::Matrix3d> orientations(const Log& log, const Reading& reading);
/// Positions in B of every row, in the unit of the log, (T,3).
Eigen::MatrixXd positions_in_base(const Log& log, const Reading& reading);

/// F = m field - m (dw x c + w x (w x c)) + bias, by robust least squares. Where the weight is
/// apart, field is without gravity, and there is a term weighed·R^T g.
struct RigidFit {
  double mass = 0.0;  ///< not below 0
  /// The estimate of any sign, and its deviation were there one residual alone: the residual's
  /// variance grows by the factor 1 + (m - free_mass)²/mass_spread² where the mass is held at m.
  double free_mass = 0.0, mass_spread = 0.0;
  double weighed = 0.0;  ///< kg, by the weight alone where a reading has it apart, of either sign
  Eigen::Vector3d moment{0, 0, 0}, bias{0, 0, 0};  ///< m c [kg m], [N]
  double variance = 0.0;                           ///< of the residual per axis, robust [N^2]
  Eigen::MatrixXd residual, force;                 ///< (n,3) in S [N]
  Eigen::MatrixXd field, covariance;               ///< (n,3) [m/s^2]; of mass, moment, bias (7,7)
};
struct FitOptions {
  Eigen::Index shift = 0;  ///< the force is read so many rows later
  bool friction = false;   ///< beside the tool: what is easily taken for a delay or a contact
  /// Its columns as smoothed_friction() has them; null: of the smoothed velocity.
  const Eigen::MatrixXd* columns = nullptr;
  /// [N] Above 0 each axis has a variance and weights of its own, of this deviation at least.
  double axis_floor = 0.0;
};
/// (n,21), three rows of seven columns each: friction of every row of the log, dry friction
/// changing its sign over `speed` [m/s], smoothed as the force is. Dry friction of a smoothed
/// velocity turns more sharply than what the smoothed force shows of it, and a shift in time mends
/// that.
Eigen::MatrixXd smoothed_friction(const Log& log, const Sampled& rows, const Reading& reading,
                                  double speed);
RigidFit fit_rigid(const Log& log, const Sampled& rows, const Kinematics& motion,
                   const Reading& reading, const FitOptions& options = {});

/// Mean of the logarithm of the residual's variance per axis over eight stretches of time, `floor`
/// [N] added to its deviation: a contact or a cable that pulls spoils one or two of them.
double log_variance(const Eigen::MatrixXd& residual, double floor);

/// What the comparison of readings came to: the likeliest one, faults applied one after another.
struct Adopted {
  Reading reading;
  Sampled rows;
  Kinematics motion;  ///< without rows where there is no pose
  RigidFit fit;
  RigidFit beside_friction;  ///< what a contact, an offset and torques are told by
  bool compared = false;     ///< a rigid tool was fitted
  double independent = 0.0;  ///< effective number of residuals
  std::vector<Fault> faults;
  std::vector<ReadingWeight> weights;
};

/// Log density of the sampling rate and the duration, with so many seconds to a unit of t.
double clock_weight(const Log& log, double seconds);

Reading declared_reading(const Log& log);
/// Log posterior but for a constant.
double log_weight(const Log& log, const Sampled& rows, const Kinematics* motion,
                  const Reading& reading);
/// The same, but next to none, by the prior alone, where numbers overflow: whoever reads such a log
/// refuses them, they are no evidence.
double finite_log_weight(const Log& log, const Sampled& rows, const Kinematics* motion,
                         const Reading& reading);
Adopted adopt(const Log& log);

}  // namespace dcnn::check
