// Which of several columns of one meaning is taken.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dcnn/import/log.h"

namespace dcnn {

/// The candidate whose name begins most like one that was said: beside objectRightFx it is
/// objectRightFy, not objectLeftFy. Nothing where two begin alike.
std::optional<std::size_t> nearest_to_said(const std::vector<std::string>& candidates,
                                           const std::vector<std::string>& said);

/// What to ask where several may be `column` and nothing said tells which.
std::string question_between(const std::string& column, const std::string& stream,
                             const std::vector<std::string>& candidates);

/// "timestamp tx ty tz qx qy qz qw" (the TUM format of trajectories): a translation.
bool is_trajectory(const LogStream& stream);

}  // namespace dcnn
