// SPDX-License-Identifier: Apache-2.0
// What several statistics of rows share.
#pragma once

#include <string>

#include "check/kind.h"
#include "check/statistics.h"
#include "data/resolution.h"
#include "dcnn/core/number.h"

namespace dcnn::check {

/// Runs of rows in which every column is equal; the value is the row's number where it began.
std::vector<Run> group_runs(const Eigen::MatrixXd& columns);
/// Measured columns one by one.
std::vector<std::string> measured_columns(const Log& log);
/// How fast the robot moves: rms step of the positions' columns in some rows, relative to that of
/// the whole log, of the column where that is most.
class RelativeSpeed {
 public:
  explicit RelativeSpeed(const Log& log);
  /// Of some columns: of a joint's position where its torque is looked at.
  RelativeSpeed(const Log& log, const std::vector<std::string>& positions);
  /// In rows [begin, end).
  double in(Eigen::Index begin, Eigen::Index end) const;

 private:
  std::vector<std::vector<double>> sums_;  // by column: of squares of relative steps up to each row
};
/// Rows as times of the log's clock; nothing without one.
void set_interval(const Log& log, Eigen::Index begin, Eigen::Index end, Fault& fault);
/// Deviations of the adopted fit's mass, moment and bias (7) [kg, kg m, N]: of its covariance, by
/// the independent ones among its residuals.
Eigen::VectorXd fit_deviations(const Adopted& adopted);
/// Number of independent residuals among (n,columns), by their correlation from row to row.
double independent_of(const Eigen::MatrixXd& residual);

}  // namespace dcnn::check
