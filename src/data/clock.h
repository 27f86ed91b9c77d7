// SPDX-License-Identifier: Apache-2.0
// The clock of a recording: increasing, without gaps inside a segment, regular.
#pragma once

#include <optional>

#include "dcnn/data/recording.h"

namespace dcnn {

/// Of an even clock whose stamps were written with so few digits that their steps differ by a
/// fifth: that clock's step [s]. None of stamps that leave it by more than their last digit
/// explains.
std::optional<double> step_of_rounded(const Eigen::VectorXd& t);

/// Whether a step of a clock [s] is a gap of the recording: longer than five of its usual steps
/// `dt` and than what jitter makes of five.
bool is_gap(double step, double dt);

/// What steps of a clock whose median step is known make in all, in medians, and how many ticks
/// they are: rows that were lost count, gaps and steps that are off a whole number by more than
/// `most_off` do not.
struct StepCount {
  double time = 0.0, ticks = 0.0;
};
StepCount count_steps(const Eigen::VectorXd& t, double median, double most_off);

/// These stretches of rows, split where a step of their times is a gap.
std::vector<Segment> split_at_gaps(const Eigen::VectorXd& t, const std::vector<Segment>& stretches,
                                   double dt);

/// Checks column t (line = row + 2 in errors that name `file`), moves its origin where it is an
/// epoch time, and fills dt and segments. A recording without t, and where `poses` one whose rows
/// are a second or more apart, is a list of poses at rest: one segment, dt 0.
void set_clock(Recording& recording, const std::string& file, bool poses);

/// More than 1 % of the steps inside segments off by more than 20 % of dt is an Error(kData); steps
/// of two to five dt are rows that were lost, at most a tenth of all, which derivatives bridge.
void check_regular(Recording& recording, const std::string& file);

/// Leaves out stretches between gaps of fewer than `least` rows (three: a second derivative), which
/// derivatives need, with a note, where there are longer ones.
void drop_short_stretches(Recording& recording, Index least = 3);

/// Puts every segment on a regular clock of `hz` (0: the recording's own rate): the columns in
/// `smooth` by cubic spline, all others linearly. Angles must be unwrapped and quaternions
/// sign-continuous before.
void resample(Recording& recording, double hz, const std::vector<std::string>& smooth);

}  // namespace dcnn
