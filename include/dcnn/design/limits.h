// SPDX-License-Identifier: Apache-2.0
// What a robot may do while it is recorded: the limits within which a motion is designed.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"
#include "dcnn/physics/chain.h"
#include "dcnn/physics/tool_model.h"

namespace dcnn::design {

struct Range {
  double low = 0.0, high = 0.0;
};

/// Of the frame E that the robot reports, in B. Speeds and what follows are lengths of vectors;
/// infinite where nothing limits them.
struct PoseLimits {
  std::array<Range, 6> range;                        ///< x,y,z [m], alpha,beta,gamma [rad]
  double speed, acceleration, jerk;                  ///< m/s, m/s², m/s³
  double rate, angular_acceleration, angular_jerk;   ///< rad/s, rad/s², rad/s³
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the work space, a shell
  Range radius;                                      ///< m
};

/// Of the joints of an arm, one entry each; the motion is then made of their angles.
struct JointLimits {
  JointChain chain;
  std::vector<Range> range;                   ///< rad (m of a joint that slides)
  Eigen::VectorXd speed, acceleration, jerk;  ///< per second, per s², per s³
};

struct Limits {
  PoseLimits pose;
  std::optional<JointLimits> joints;
  Eigen::VectorXd start;  ///< pose or joints where the motion begins and ends, at rest
  double rate_hz = 500.0;
};

/// docs/use/discover.md has the keys. A missing, unknown or impossible one is an Error(kUsage) that
/// names `where`; files are looked for in `folder`.
Limits parse_limits(const Json& json, const std::string& where,
                    const std::filesystem::path& folder);
Limits read_limits(const std::filesystem::path& path);
/// Of a pose, as parse_limits() reads them.
Json to_json(const Limits& limits);

/// What recordings show that the robot does: every direction as far, as fast and as sharply as the
/// one that moved most. Nothing where they hold no motion with a position.
std::optional<Limits> driven_limits(const std::vector<Recording>& recordings,
                                    const ToolModel& model);

}  // namespace dcnn::design
