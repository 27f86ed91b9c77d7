// SPDX-License-Identifier: Apache-2.0
// The ten inertial parameters of a tool and the sensor's bias from force and torque.
#pragma once

#include <Eigen/Dense>

#include "models/least_squares.h"
#include "models/regressors.h"

namespace dcnn {

/// m, h = m·c (3), Ixx, Iyy, Izz, Ixy, Ixz, Iyz about the origin of S, bias of force (3) and of
/// torque (3); SI, frame S.
using InertialParameters = Eigen::Matrix<double, 16, 1>;

/// The weights (terms of Terms::kRigid, 6) of fx…tz; linear in the parameters.
Eigen::MatrixXd inertial_weights(const InertialParameters& parameters, const WristColumns& columns);

/// Density-weighted second moments and mass: [[tr(I)/2·1 - I, h], [h^T, m]]. There is a body with
/// these parameters if and only if it is positive semidefinite (Wensing, Kim and Slotine 2018).
Eigen::Matrix4d pseudo_inertia(const InertialParameters& parameters);

struct InertialFit {
  InertialParameters parameters;
  bool constraint_active = false;  ///< least squares alone gave a body that cannot exist
  double free_mass = 0.0;          ///< kg, of least squares alone
};

/// Weighted least squares of the six targets jointly, each in units of its own scatter, with a
/// pseudo-inertia that is positive semidefinite: where the plain solution is not, Levenberg-
/// Marquardt on its log-Cholesky factor (Rucker and Wensing 2022), which has no local minima since
/// the problem is convex in the pseudo-inertia.
InertialFit fit_inertial(const LeastSquares& sums, const WristColumns& columns);

}  // namespace dcnn
