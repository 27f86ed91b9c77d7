// SPDX-License-Identifier: Apache-2.0
// Short excursions of a channel: a few rows, all moved alike, between neighbours that are alike.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/check/log.h"

namespace dcnn::check {

/// Rows of one width that noise is least likely to have moved: so many, so far.
struct Excursions {
  Eigen::Index width = 1;          ///< rows of each
  std::vector<Eigen::Index> rows;  ///< the first of each, ascending
  double height = 0.0;             ///< of the farthest, in deviations from its neighbours
  double p = 1.0;                  ///< under noise with Student's tail of five degrees of freedom

  /// "2 stretches of 2 rows of fz are up to 40 deviations off their neighbours"
  std::string words(const std::string& column) const;
};

/// The least probable of widths of one to three rows; what lasts longer is felt, not misread.
Excursions excursions_of(const Eigen::VectorXd& values);

/// A copy in which those rows have the mean of their neighbours.
Eigen::VectorXd without(const Excursions& excursions, Eigen::VectorXd values);

/// Columns of the pose and of joints as continuous signals: whole turns of angles, of `angle_unit`
/// rad per unit of the file, and signs of quaternions leave no steps. Lengths are as logged.
Eigen::MatrixXd continuous_positions(const Log& log, double angle_unit);

}  // namespace dcnn::check
