// SPDX-License-Identifier: Apache-2.0
// Which of several columns of one meaning is taken.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dcnn/import/recipe.h"

namespace dcnn {

/// The candidate whose name begins most like one that was said: beside objectRightFx it is
/// objectRightFy, not objectLeftFy. Nothing where two begin alike.
std::optional<std::size_t> nearest_to_said(const std::vector<std::string>& candidates,
                                           const std::vector<std::string>& said);

/// A name around its last number: "Joint_3" is {"Joint_", 3, ""}.
struct Counted {
  std::string before, after;
  int number = 0;
};
std::optional<Counted> counted(const std::string& name);

/// The channel of `column` where one was said for another of the vector's `columns`: fy_raw beside
/// fx=fx_raw, FT_Sensor[1] beside fx=FT_Sensor[0], Q2 beside qw=Q1.
std::optional<ColumnRule> in_said_array(const LogStream& stream,
                                        const std::vector<std::string>& columns,
                                        const std::string& column,
                                        const std::vector<ColumnRule>& said);

/// Whether a channel may be one that follows a said one: other by a letter or the last number.
bool may_follow(const std::string& said, const std::string& channel);

/// What to ask where several may be `column` and nothing said tells which.
std::string question_between(const std::string& column, const std::string& stream,
                             const std::vector<std::string>& candidates);

/// "timestamp tx ty tz qx qy qz qw" (the TUM format of trajectories): a translation.
bool is_trajectory(const LogStream& stream);

}  // namespace dcnn
