// SPDX-License-Identifier: Apache-2.0
// Rows that were taken when their stamps say, off an even clock by parts of a step.
#pragma once

#include <string>
#include <vector>

#include "dcnn/data/recording.h"

namespace dcnn {

/// How far each row of a segment is off a clock that ticks evenly, as the mean of the stamps of up
/// to 25 rows on either side has it [s].
Eigen::VectorXd off_even_clock(const Eigen::VectorXd& t, const Segment& segment, double dt);

/// ln of the likelihood of `columns` (T each) if every row was taken at its stamp, over that if the
/// rows were taken evenly and only the stamps jitter: a position at speed v is off by v times the
/// stamp's part of it then. From fourth differences, which a motion hardly has.
double log_odds_of_stamps(const Recording& recording, const std::vector<std::string>& columns);

/// Where the columns' rows were taken at their stamps (odds above 1000): puts the columns at the
/// times of the even clock, by cubic spline, and t with them; others, which change little in such
/// parts of a step, stay. Angles must be unwrapped and quaternions sign-continuous. Whether they
/// were.
bool put_on_even_clock(Recording& recording, const std::vector<std::string>& columns);

}  // namespace dcnn
