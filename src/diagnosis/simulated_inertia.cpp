// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/simulated_inertia.h"

#include "core/linear_algebra.h"

namespace dcnn {
namespace {

constexpr Index kQuiet = 6;             // columns: a constant in the base and one in the sensor
constexpr double kColumnRidge = 1e-12;  // of a column's information
constexpr double kNothingLeft = 1e-12;  // of the square of all: rounding

using Columns = Eigen::Matrix<double, 3, kQuiet + 1>;

/// Square of what the first `count` columns leave.
double left_by(const Eigen::MatrixXd& gram, const Eigen::VectorXd& match, double square,
               Index count) {
  const Eigen::VectorXd x =
      solve_gram(gram.topLeftCorner(count, count), match.head(count), kColumnRidge);
  return square - x.dot(match.head(count));
}

}  // namespace

bool simulates_inertia(const std::vector<Log>& logs) {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(kQuiet + 1, kQuiet + 1);
  Eigen::VectorXd match = Eigen::VectorXd::Zero(kQuiet + 1);
  double square = 0.0;
  for (const Log& log : logs) {
    const Motion& motion = log.motion;
    if (motion.a_B.rows() != motion.samples() || log.base.force.rows() == 0) return false;
    for (Index k = 0; k < motion.samples(); ++k) {
      const Eigen::Matrix3d to_S = motion.R_BS[static_cast<std::size_t>(k)].transpose();
      Columns columns;
      columns << to_S, Eigen::Matrix3d::Identity(), to_S * motion.a_B.row(k).transpose();
      const Eigen::Vector3d force = log.base.force.row(k);
      gram += columns.transpose() * columns;
      match += columns.transpose() * force;
      square += force.squaredNorm();
    }
  }
  const double quiet = left_by(gram, match, square, kQuiet);
  if (!(quiet > kNothingLeft * square)) return false;
  return left_by(gram, match, square, kQuiet + 1) < 0.5 * quiet;
}

}  // namespace dcnn
