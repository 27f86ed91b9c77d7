// SPDX-License-Identifier: Apache-2.0
// Several columns of one source that keep their values together for a while.
#pragma once

#include "check/rows.h"

namespace dcnn::check {

/// Runs in which the columns of a source stand still, that chance is least likely to have made.
struct Stalls {
  std::vector<Run> runs;  ///< the longest first
  double p = 1.0;
};

/// Values of a sensor that are kept though the robot moves: so many runs so long, among rows that
/// repeat as often as those of the other runs do.
Stalls stalls_of_sensor(const Log& log, const std::vector<std::string>& columns);

/// Positions, of a pose or of one joint, that stand still and then jump to where the robot has gone
/// while its sensors go on: the step at the end against those about the run, under Student's tail
/// with five degrees of freedom. One that rests starts gently.
Stalls stalls_of_positions(const Log& log, const std::vector<std::string>& names,
                           const std::vector<std::vector<std::string>>& sensors);

}  // namespace dcnn::check
