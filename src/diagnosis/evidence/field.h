// SPDX-License-Identifier: Apache-2.0
// What physics outside the catalogue may depend on: fields of functions with one variance each.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence/grid.h"

namespace dcnn::evidence {

/// Functions of one driver along one axis, a Gaussian process with an amplitude of its own.
struct Field {
  std::string driver;       ///< in words, as in "the velocity along the sensor's z axis"
  std::string axis;         ///< along which it pushes, as in "sensor_z", or a channel
  std::string kind;         ///< state, memory or clock
  Eigen::MatrixXd columns;  ///< (rows of the grid, functions), of unit mean square in all
};

/// State: velocities, rates, accelerations, forces, pose and products of them. Memory: forces
/// behind low-passes of 0.3 to 30 s, bristles and play. Clock: slow waves. `prediction` is the
/// force of the model at hand at the grid's samples.
std::vector<Field> fields(const Grid& grid, const Signals& prediction);

}  // namespace dcnn::evidence
