// SPDX-License-Identifier: Apache-2.0
#include "physics/delay.h"

#include <vector>

namespace dcnn {
namespace {

/// Lagrange's form through four samples at these instants, which are not even: a row was lost.
double interpolate_uneven(const double* instants, const double* x, double at) {
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    double weight = x[k];
    for (int other = 0; other < 4; ++other) {
      if (other != k) weight *= (at - instants[other]) / (instants[k] - instants[other]);
    }
    sum += weight;
  }
  return sum;
}

/// Rows of a segment in samples since its first. A row that was lost is a step of two or more.
std::vector<double> instants_of(const Motion& motion, const Segment& segment) {
  std::vector<double> instants(static_cast<std::size_t>(segment.size()), 0.0);
  for (std::size_t k = 1; k < instants.size(); ++k) {
    const Index row = segment.begin + static_cast<Index>(k);
    const double step = std::round((motion.t(row) - motion.t(row - 1)) / motion.dt);
    instants[k] = instants[k - 1] + std::max(1.0, step);
  }
  return instants;
}

/// What x was `samples` earlier.
Eigen::VectorXd earlier(const Eigen::VectorXd& x, const std::vector<double>& instants,
                        double samples) {
  const auto size = instants.size();
  Eigen::VectorXd result(x.size());
  std::size_t before = 0;  // the last row at or before the instant that is wanted
  for (std::size_t k = 0; k < size; ++k) {
    const double wanted = instants[k] - samples;
    while (before + 1 < size && instants[before + 1] <= wanted) ++before;
    const std::size_t first = size < 4 ? 0 : std::clamp<std::size_t>(before, 1, size - 3) - 1;
    const bool inside = wanted > 0.0 && wanted < instants.back();
    const bool uneven = size >= 4 && instants[first + 3] - instants[first] > 3.0;
    result(static_cast<Index>(k)) =
        inside && uneven
            ? interpolate_uneven(&instants[first], x.data() + first, wanted)
            : interpolate(x, x.size(),
                          inside ? static_cast<double>(first) + wanted - instants[first]
                                 : (wanted > 0.0 ? static_cast<double>(size) : 0.0));
  }
  return result;
}

}  // namespace

void delay(Eigen::MatrixXd& signals, const Motion& motion, double seconds) {
  if (signals.isZero(0.0)) return;  // torques where only forces are meant, or no rows
  for (const Segment& segment : motion.segments) {
    const std::vector<double> instants = instants_of(motion, segment);
    for (Index i = 0; i < signals.cols(); ++i) {
      auto column = signals.col(i).segment(segment.begin, segment.size());
      if (column.isZero(0.0)) continue;
      column = earlier(Eigen::VectorXd(column), instants, seconds / motion.dt);
    }
  }
}

}  // namespace dcnn
