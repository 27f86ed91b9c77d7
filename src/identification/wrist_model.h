// SPDX-License-Identifier: Apache-2.0
// The rigid tool behind an unknown mounting as a regression.
//
// In E, the frame whose pose is logged, with the field f = R_BE^T (g - a_o), angular velocity w and
// acceleration dw, S(v) the matrix of v x:
//
//   F_S = R_SE [m f - (S(dw) + S(w)^2) h] + b,      h = m c
//   T_S = R_SE [h x f - I dw - w x I w] + b_T
//
// is linear in m, h, I, b and b_T, and R_SE acts on three components that are filtered before it.
#pragma once

#include <string>
#include <vector>

#include "identification/wrist_log.h"

namespace dcnn::identification {

/// What may act beside the rigid tool: a law of the catalogue, with the amplitudes it is linear in.
struct Law {
  std::string effect, axis;
  std::vector<std::string> names, units;  ///< of its amplitudes
  bool dissipates = false;                ///< amplitudes below zero refute it
  double turning = 0.05;  ///< dry friction: share of the velocity's deviation over which it turns
};

/// The state of the fit: numbers in E, and the laws beside the tool.
struct WristState {
  double mass = 1.0;
  Eigen::Vector3d h = Eigen::Vector3d::Zero();        ///< mass times centre of mass, kg·m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the origin
  Eigen::Matrix3d R_SE = Eigen::Matrix3d::Identity();
  Eigen::Vector3d bias = Eigen::Vector3d::Zero(), bias_torque = Eigen::Vector3d::Zero();
  std::vector<Law> laws;
  Eigen::VectorXd amplitudes;  ///< of all laws, in order
};

/// Where the parts of a parameter vector begin: m, h, I (xx yy zz xy xz yz), a turn of E (rad), b,
/// b_T, amplitudes. Without torque there is neither I nor b_T.
struct Layout {
  bool torque = false, mounting = true;
  Index amplitudes = 0;  ///< how many

  Index inertia() const { return 4; }
  Index turn() const { return torque ? 10 : 4; }
  Index bias() const { return turn() + (mounting ? 3 : 0); }
  Index bias_torque() const { return bias() + 3; }
  Index first_amplitude() const { return bias() + (torque ? 6 : 3); }
  Index size() const { return first_amplitude() + amplitudes; }
  Index channels() const { return torque ? 6 : 3; }
};

/// The filtered regressors of one log in E.
struct WristColumns {
  Eigen::MatrixXd y;      ///< (n, channels)
  Eigen::MatrixXd field;  ///< (n, 3): f
  Eigen::MatrixXd swing;  ///< (n, 9): -(S(dw) + S(w)^2), by rows
  Eigen::MatrixXd spin;   ///< (n, 18): of -I dw - w x I w in the order of the layout, by rows
  Eigen::MatrixXd laws;   ///< (n, channels·amplitudes): one block of channels for each amplitude

  Index rows() const { return y.rows(); }
};
WristColumns columns_of(const WristLog& log, bool torque);

/// The state moved by a step of the parameters.
WristState moved(const WristState& state, const Layout& layout, const Eigen::VectorXd& step);
/// The parameters of a state; the turn is zero.
Eigen::VectorXd parameters_of(const WristState& state, const Layout& layout);

/// (n, channels): what the sensor reads.
Eigen::MatrixXd predicted(const WristColumns& columns, const WristState& state);
/// (n·channels, size), channel by channel: its derivatives by the parameters.
Eigen::MatrixXd jacobian(const WristColumns& columns, const WristState& state,
                         const Layout& layout);

/// The rotation exp(S(turn)).
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& turn);
/// xx yy zz xy xz yz.
Eigen::Matrix3d symmetric_of(const Eigen::Ref<const Eigen::VectorXd>& i);
Eigen::VectorXd six_of(const Eigen::Matrix3d& I);

}  // namespace dcnn::identification
