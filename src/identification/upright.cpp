// SPDX-License-Identifier: Apache-2.0
#include "identification/upright.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "core/linear_algebra.h"

namespace dcnn::identification {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

// Independent residuals at most: what no tool explains is alike for long.
constexpr double kIndependentRows = 40.0;
constexpr double kOddsOfAnotherBase = 1e3;  // of another vertical over another mounting
constexpr double kLeastTurn = 20.0 * std::numbers::pi / 180.0;  // less is a law beside the tool

/// Sums over all logs, each about its own mean, so that no offset matters.
struct FieldSums {
  Matrix3d gram = Matrix3d::Zero();
  Vector3d match = Vector3d::Zero();
  Matrix3d turned = Matrix3d::Zero();  ///< F' f, f the vertical in E
  double force = 0.0, field = 0.0, rows = 0.0;
};

FieldSums field_sums(const std::vector<WristLog>& logs, const Matrix3d& R_SE) {
  FieldSums sums;
  for (const WristLog& log : logs) {
    const Index n = log.motion.samples();
    MatrixXd columns(n, 9);  // R_SE R_BE', by rows: F_S = columns w
    for (Index k = 0; k < n; ++k) {
      const Matrix3d R = R_SE * log.motion.R_BS[static_cast<std::size_t>(k)].transpose();
      columns.row(k) << R.row(0), R.row(1), R.row(2);
    }
    MatrixXd force = log.measured.leftCols(3), field(n, 3);
    for (Index k = 0; k < n; ++k) {
      field.row(k) = log.motion.R_BS[static_cast<std::size_t>(k)].row(2);  // R_BE' e_z
    }
    for (MatrixXd* x : {&columns, &force, &field}) x->rowwise() -= x->colwise().mean().eval();
    for (Index i = 0; i < 3; ++i) {
      const auto A = columns.middleCols(3 * i, 3);
      sums.gram += A.transpose() * A;
      sums.match += A.transpose() * force.col(i);
    }
    sums.turned += force.transpose() * field;
    sums.force += force.squaredNorm();
    sums.field += field.squaredNorm();
    sums.rows += static_cast<double>(n);
  }
  return sums;
}

}  // namespace

std::optional<Matrix3d> upright_turn(const std::vector<WristLog>& logs, const Matrix3d& R_ES) {
  const FieldSums sums = field_sums(logs, R_ES.transpose());
  if (!(sums.force > 0.0) || !(sums.field > 0.0)) return std::nullopt;
  const Vector3d weight = solve_gram(sums.gram, sums.match, 1e-11);
  // Shares of the force that are left: of any weight in the base, and of gravity along -z behind
  // the best mounting (Kabsch 1976: the sum of singular values, the last with the sign of a
  // rotation).
  const double free_left = std::max(1.0 - weight.dot(sums.match) / sums.force, 1e-12);
  const auto svd = singular_values(sums.turned);
  const double sign = (svd.U * svd.V.transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const double along = svd.values[0] + svd.values[1] + sign * svd.values[2];
  const double level_left = std::max(1.0 - along * along / (sums.force * sums.field), 1e-12);
  const double odds =
      0.5 * std::min(sums.rows, kIndependentRows) * elementary::log(level_left / free_left);
  const Vector3d down = weight.normalized();
  const double turn = elementary::acos(std::clamp(-down.z(), -1.0, 1.0));
  if (odds < elementary::log(kOddsOfAnotherBase) || turn < kLeastTurn) return std::nullopt;
  return Eigen::Quaterniond::FromTwoVectors(down, -Vector3d::UnitZ()).toRotationMatrix();
}

void turn_base(const Matrix3d& Q, WristLog& log) {
  Motion& motion = log.motion;
  for (Matrix3d& R : motion.R_BS) R = Q * R;
  for (MatrixXd* vectors : {&motion.v_B, &motion.a_B, &motion.p_B}) {
    if (vectors->rows() > 0) *vectors = *vectors * Q.transpose();
  }
}

}  // namespace dcnn::identification
