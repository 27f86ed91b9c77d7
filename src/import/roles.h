// SPDX-License-Identifier: Apache-2.0
// What a channel is, by its name.
#pragma once

#include <string>
#include <vector>

#include "dcnn/import/log.h"

namespace dcnn {

/// The column that a channel becomes: "fx", "x", "qw", "alpha"; "r11" … "r33" (rotation matrix),
/// "rvx" … (rotation vector), "rot1" … (angles in an order to be said), "rx" … (either of the two),
/// "q:elbow", "qd:elbow", "tau:elbow", "current:elbow" (joints). Empty where the name says nothing.
std::string role_of(const LogStream& stream, const std::string& channel);

/// What to say of a log in which no channel is known by its name, with a command for this log.
std::string how_to_name(const ForeignLog& log);

/// Lower-case words of a name: "Force[X] (N)" is {force, x}.
std::vector<std::string> words_of_name(const std::string& name);

/// What a controller wants, what was simulated or a statistic, by the words of its name.
bool is_no_measurement(const std::vector<std::string>& words);

/// A clock's column: 3 header stamp, 2 a word for time, 1 the single letter; 0 no clock.
int clock_rank(const std::string& channel);
/// Whole seconds (1) and nanoseconds (2) of a stamp in two columns; 0 neither.
int stamp_part(const std::string& channel);

}  // namespace dcnn
