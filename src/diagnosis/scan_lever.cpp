// SPDX-License-Identifier: Apache-2.0
// Where torques are measured: the lever at which a force acts, fitted beside its amplitudes.
#include "diagnosis/scan.h"

namespace dcnn {

void Scan::fit_lever(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& beside, Detail detail,
                     Trial& trial) const {
  constexpr double kLever = 0.1;  // m, of a difference; the torque is linear in the lever
  Member own = trial.member;
  // At no lever, or another one, a force may explain nothing beside its torque: from the forces
  // alone, which noise that is correlated leaves as they are.
  const Eigen::VectorXd left = residual_(force_rows_);
  const Eigen::MatrixXd of_forces = columns(force_rows_, Eigen::all);
  own.amplitudes = least_squares(of_forces, left);
  if (!own.amplitudes.allFinite() || !is_possible(own)) return;
  if (left.dot(of_forces * own.amplitudes) < setting_.price) return;
  const Index amplitudes = columns.cols(), levers = own.levers(), first = own.own_shapes();
  Eigen::MatrixXd all(columns.rows(), amplitudes + levers);
  all.leftCols(amplitudes) = columns;
  const Eigen::VectorXd here = added(own, detail);
  for (Index k = 0; k < levers; ++k) {
    Member moved = own;
    moved.shapes(first + k) += kLever;
    Eigen::MatrixXd column = off_model((added(moved, detail) - here) / kLever);
    if (beside.cols() > 0) column -= beside * (beside.transpose() * column);
    all.col(amplitudes + k) = column;
  }
  const Eigen::VectorXd best = least_squares(all, residual_);
  if (!best.allFinite()) return;
  Member placed = own;
  placed.amplitudes = best.head(amplitudes);
  for (Index k = 0; k < levers; ++k) {
    const double lever = own.shapes(first + k) + best(amplitudes + k);
    placed.shapes(first + k) = from_search_scale(placed, first + k, lever);
  }
  if (!is_possible(placed)) return;
  trial.member = std::move(placed);
  trial.gain = best.dot(all.transpose() * residual_);
}

}  // namespace dcnn
