// SPDX-License-Identifier: Apache-2.0
// Motion and forces at a high rate: own rotations, differences and integrators.
#pragma once

#include "dcnn/conceal/scenario.h"
#include "dcnn/core/random.h"

namespace dcnn::conceal {

constexpr double kStep = 1.0 / 4000.0;  // s

Climate draw_climate(Rng& rng);

/// A recording's motion, 4000 samples a second.
struct Path {
  double start = 0.0;   // s, clock of the first sample
  double step = kStep;  // s
  Climate climate;
  Eigen::MatrixXd pose;                    // (T, 6)
  std::vector<Eigen::Matrix3d> rotation;   // sensor to base
  Eigen::MatrixXd velocity, acceleration;  // (T, 3), base
  Eigen::MatrixXd rate, rate_derivative;   // (T, 3), sensor
  Eigen::MatrixXd load;   // (T, 3) N, what an axis of a machine transmits; no rows: a tool
  Eigen::MatrixXd rigid;  // (T, 3) N, reaction of an arm's rigid body; no rows: the tool's alone
  Eigen::Index samples() const { return pose.rows(); }
  double time(Eigen::Index i) const { return start + step * static_cast<double>(i); }
};

/// Velocities, accelerations and rates of a pose (T, 6) whose frames are `rotation`; the sensor is
/// mounted in them with rpy `mounting`.
Path follow(double start, const Eigen::MatrixXd& pose, std::vector<Eigen::Matrix3d> rotation,
            const Eigen::Vector3d& mounting);

/// The motion of a recording without gaps, smoothed over some 20 ms. Orientations pass through
/// quaternions, so that no Euler singularity matters but to the angles.
Path path_of(const Recording& recording, const Eigen::Vector3d& mounting);

/// Motions: human, multisine, points, scan, repeats; poor: harmonic, planar. With the conditions'
/// tremor.
Path make_path(const std::string& motion, double start, double seconds,
               const Eigen::Vector3d& mounting, const Conditions& conditions, std::uint64_t seed);

inline const Eigen::Vector3d kGravity{0.0, 0.0, -9.81};  ///< in B [m/s^2]
/// Gravity less the acceleration of the sensor's origin, in the sensor frame (T, 3) [m/s^2].
Eigen::MatrixXd felt_field(const Path& path, const Eigen::Vector3d& gravity = kGravity);
/// Force on the sensor and what it makes of it, (T, 3) or with the torque of a tool with beads
/// (T, 6), before noise and digits.
Eigen::MatrixXd force(const Path& path, const Tool& tool, const std::vector<Hidden>& hidden);
/// Clipping and rounding, in place.
void digitise(const std::vector<Hidden>& hidden, Eigen::MatrixXd& F);
/// Every `stride`-th sample of the reading, (T, 3 or 6); `noise` may be empty.
Eigen::MatrixXd reading(const Path& path, const Tool& tool, const std::vector<Hidden>& hidden,
                        const Eigen::MatrixXd& noise, int stride);

/// Inertia about the origin of S [kg m^2].
Eigen::Matrix3d inertia_of(const Tool& tool);
/// Torque (T, 3) about the origin of S: that of the nominal tool's point masses, and of the mass
/// and centre that `tool` has beyond it.
Eigen::MatrixXd rigid_torque(const Path& path, const Tool& nominal, const Tool& tool,
                             const Eigen::Vector3d& gravity);

}  // namespace dcnn::conceal
