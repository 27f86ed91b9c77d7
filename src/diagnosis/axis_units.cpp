// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/axis_units.h"

#include <algorithm>
#include <cmath>

namespace dcnn {
namespace {

/// By how much an amplitude leaves what machines of usual size move by, or how fast: 0.05 to 5 rad
/// or m, and as much in a second. Laws of friction have their scales in these units; a machine far
/// from that size, or logged in another unit, has its own.
double beyond_usual(double amplitude) { return amplitude / std::clamp(amplitude, 0.05, 5.0); }

}  // namespace

void set_axis_units(Case& study) {
  double position = 0.0, rate = 0.0, rows = 0.0;
  for (const Log& log : study.logs) {
    const Eigen::VectorXd q = log.motion.euler.col(0);
    position += (q.array() - q.mean()).square().sum();
    if (log.motion.v_B.rows() > 0) rate += log.motion.v_B.col(0).squaredNorm();
    rows += static_cast<double>(q.size());
  }
  const double length = std::sqrt(2.0 * position / rows), speed = std::sqrt(2.0 * rate / rows);
  if (!study.axis_moves || !(speed > 0.0)) return;
  study.axis_length = beyond_usual(length > 0.0 ? length : speed);
  study.axis_seconds = study.axis_length / beyond_usual(speed);
}

}  // namespace dcnn
