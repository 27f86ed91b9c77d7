// SPDX-License-Identifier: Apache-2.0
// Recordings of an arm as the rows of one regression.
#pragma once

#include "dcnn/identification/arm.h"
#include "identification/wrist_log.h"

namespace dcnn::identification {

struct ArmLog {
  WristLog clock;  ///< recording, low-pass and thinning
  bool loaded = false;
  Eigen::MatrixXd q, v, a;        ///< (T, joints), as logged or derived
  Eigen::MatrixXd smooth_q;       ///< (T, joints), low-passed
  Eigen::MatrixXd torque;         ///< (n, joints) in the joints' units
  std::vector<Eigen::MatrixXd> rigid;  ///< of each joint: (n, 10·joints)
};

/// Reads recordings by the system description and low-passes torques and regressors together. Poses
/// at rest (without times, or rows far apart) are taken as they are: a row each, without rates.
std::vector<ArmLog> read_arm_logs(const std::vector<std::filesystem::path>& paths, bool loaded,
                                  const System& system, const JointChain& chain);

/// Rows of which one is as good as independent: 1 + 2 times the sum of the autocorrelation of a
/// joint's residual up to where it first is negative; 1 at rest.
double correlated_rows(const ArmLog& log, const Eigen::VectorXd& residual);

/// What turns dry friction from one side to the other over a path `length` (Dahl 1968), and creeps to
/// zero at rest: dz = (1 - z sgn(dq)) dq/length - z `creep` for each row, z = 0 at the start of each
/// segment; (T).
Eigen::VectorXd dahl_state(const Eigen::VectorXd& q, const std::vector<Segment>& segments,
                           double length, double creep = 0.0);

}  // namespace dcnn::identification
