// SPDX-License-Identifier: Apache-2.0
// Rows that a log lost, on the even clock that spectra and filters need.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/data/recording.h"

namespace dcnn {

/// Where the rows of a segment stand on a clock that ticks every dt: 0, 1, … but for lost rows.
std::vector<Index> clock_places(const Eigen::VectorXd& t, const Segment& segment, double dt);

/// A segment's rows on every tick of the clock, lost ones by a cubic spline through the others.
Eigen::VectorXd bridged(const Eigen::Ref<const Eigen::VectorXd>& x,
                        const std::vector<Index>& places);

/// Signals of a recording, (T, columns), on every tick, and where its segments are then.
struct Bridged {
  Eigen::MatrixXd columns;
  std::vector<Segment> segments;
};
Bridged bridged(const Eigen::MatrixXd& signals, const Recording& recording);

/// Column t, or the times of so many rows that are dt apart.
Eigen::VectorXd times_of(const Recording& recording, Index rows);

}  // namespace dcnn
