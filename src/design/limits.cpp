// SPDX-License-Identifier: Apache-2.0
#include "dcnn/design/limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dcnn/core/options.h"
#include "dcnn/identification/urdf.h"
#include "dcnn/physics/motion.h"
#include "design/joints.h"

namespace dcnn::design {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kLargest = 1e6;   // of any limit, in SI: beyond it a file is in other units
constexpr double kSteepest = 1.5;  // rad, |beta|: at pi/2 alpha and gamma are one angle

Range read_range(Options& options, const std::string& key, double most) {
  const auto list = options.get<std::vector<double>>(key);
  const bool right = list.size() == 2 && std::isfinite(list[0]) && list[0] <= list[1] &&
                     std::abs(list[0]) <= most && std::abs(list[1]) <= most;
  if (!right) options.reject(key, "must be [low, high] with low <= high, each at most ", most);
  return {list[0], list[1]};
}

double read_most(Options& options, const std::string& key, bool needed) {
  if (!options.has(key)) {
    if (needed) options.reject(key, "is missing; a motion needs this limit");
    return kUnlimited;
  }
  const double value = options.get<double>(key);
  if (!(value > 0.0 && value <= kLargest))
    options.reject(key, "must be above 0 and at most ", kLargest);
  return value;
}

Eigen::Vector3d read_three(Options& options, const std::string& key) {
  const auto list = options.get<std::vector<double>>(key);
  if (list.size() != 3) options.reject(key, "must have three numbers");
  return {list[0], list[1], list[2]};
}

void read_work_space(Options options, PoseLimits& pose) {
  pose.center = read_three(options, "center_m");
  pose.radius = read_range(options, "radius_m", kLargest);
  if (pose.radius.low < 0.0) options.reject("radius_m", "must not be negative");
  options.finish();
}

PoseLimits read_pose(Options& options, bool of_joints) {
  PoseLimits pose;
  const std::pair<const char*, std::vector<std::string>> groups[] = {
      {"position_m", {"x", "y", "z"}}, {"angle_rad", {"alpha", "beta", "gamma"}}};
  for (std::size_t g = 0; g < 2; ++g) {
    const auto& [key, names] = groups[g];
    if (!options.has(key) && !of_joints) {
      options.reject(key, "is missing; it holds the ranges ", names[0], ", ", names[1], " and ",
                     names[2]);
    }
    Options ranges = options.child(key);
    for (std::size_t i = 0; i < 3; ++i) {
      const bool free = of_joints && !ranges.has(names[i]);
      const bool is_beta = g == 1 && i == 1;
      pose.range[3 * g + i] =
          free ? Range{-kUnlimited, kUnlimited}
               : read_range(ranges, names[i], is_beta && !of_joints ? kSteepest : kLargest);
    }
    ranges.finish();
  }
  pose.speed = read_most(options, "speed_mps", !of_joints);
  pose.acceleration = read_most(options, "acceleration_mps2", !of_joints);
  pose.jerk = read_most(options, "jerk_mps3", false);
  pose.rate = read_most(options, "rate_radps", !of_joints);
  pose.angular_acceleration = read_most(options, "acceleration_radps2", !of_joints);
  pose.angular_jerk = read_most(options, "jerk_radps3", false);
  pose.radius = {0.0, kUnlimited};
  if (options.has("work_space")) read_work_space(options.child("work_space"), pose);
  return pose;
}

Eigen::VectorXd read_per_joint(Options& options, const std::string& key, Index joints,
                               bool needed) {
  if (!needed && !options.has(key)) return Eigen::VectorXd::Constant(joints, kUnlimited);
  const auto list = options.get<std::vector<double>>(key);
  const bool right =
      static_cast<Index>(list.size()) == joints &&
      std::all_of(list.begin(), list.end(), [](double v) { return v > 0.0 && v <= kLargest; });
  if (!right) options.reject(key, "must have a number above 0 for each of the ", joints, " joints");
  return Eigen::Map<const Eigen::VectorXd>(list.data(), joints);
}

JointLimits read_joints(Options options, const std::string& where,
                        const std::filesystem::path& folder, Eigen::VectorXd& start) {
  JointLimits joints;
  if (options.has("urdf") == options.has("dh"))
    options.reject("urdf", "or 'dh' must say what the arm is, one of them");
  if (options.has("urdf")) {
    joints.chain = read_urdf_chain(folder / options.get<std::string>("urdf"),
                                   options.get("tip", std::string()));
  } else {
    const Json dh{{"convention", options.get("convention", std::string("modified"))},
                  {"dh", options.raw("dh")}};
    joints.chain = parse_chain(dh, where, Exit::kUsage);
  }
  const auto count = static_cast<Index>(joints.chain.joints.size());
  const auto ranges = options.raw("range");
  if (!ranges.is_array() || static_cast<Index>(ranges.size()) != count) {
    options.reject("range", "must have [low, high] for each of the ", count, " joints");
  }
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    Options one(Json{{"range", ranges[k]}}, where, Exit::kUsage);
    joints.range.push_back(read_range(one, "range", kLargest));
  }
  joints.speed = read_per_joint(options, "speed", count, true);
  joints.acceleration = read_per_joint(options, "acceleration", count, true);
  joints.jerk = read_per_joint(options, "jerk", count, false);
  start.resize(count);
  for (Index k = 0; k < count; ++k) {
    const Range& r = joints.range[static_cast<std::size_t>(k)];
    start(k) = 0.5 * (r.low + r.high);
  }
  if (options.has("start")) {
    const auto list = options.get<std::vector<double>>("start");
    if (static_cast<Index>(list.size()) != count)
      options.reject("start", "must have ", count, " numbers");
    start = Eigen::Map<const Eigen::VectorXd>(list.data(), count);
  }
  options.finish();
  return joints;
}

Eigen::VectorXd read_start(Options& options, const PoseLimits& pose) {
  Eigen::VectorXd start(6);
  for (std::size_t k = 0; k < 6; ++k) {
    start(static_cast<Index>(k)) = 0.5 * (pose.range[k].low + pose.range[k].high);
  }
  if (!options.has("start")) return start;
  Options given = options.child("start");
  if (given.has("position_m")) start.head(3) = read_three(given, "position_m");
  if (given.has("angle_rad")) start.tail(3) = read_three(given, "angle_rad");
  given.finish();
  return start;
}

bool inside(const Range& range, double value) { return value >= range.low && value <= range.high; }

void check_start(const Limits& limits, Options& options) {
  Eigen::VectorXd pose = limits.start;
  if (limits.joints) {
    for (Index k = 0; k < limits.start.size(); ++k) {
      if (!inside(limits.joints->range[static_cast<std::size_t>(k)], limits.start(k))) {
        options.reject("joints", "has a start outside of the range of joint ", k + 1);
      }
    }
    pose = pose_of(limits.joints->chain, limits.start);
  }
  const char* const names[] = {"x", "y", "z", "alpha", "beta", "gamma"};
  for (std::size_t k = 0; k < 6; ++k) {
    if (!inside(limits.pose.range[k], pose(static_cast<Index>(k)))) {
      options.reject("start", "has ", names[k], " = ", pose(static_cast<Index>(k)),
                     ", outside of its range");
    }
  }
  if (!inside(limits.pose.radius, (pose.head<3>() - limits.pose.center).norm())) {
    options.reject("work_space", "does not hold the start; give another 'start'");
  }
}

}  // namespace

Limits parse_limits(const Json& json, const std::string& where,
                    const std::filesystem::path& folder) {
  require(json.is_object(), Exit::kUsage, where,
          ": must hold an object of limits, such as {\"speed_mps\": 0.25, ...}");
  Options options(json, where, Exit::kUsage);
  Limits limits;
  limits.rate_hz = options.number("rate_hz", limits.rate_hz, 20.0, 10000.0);
  limits.pose = read_pose(options, options.has("joints"));
  if (options.has("joints")) {
    limits.joints = read_joints(options.child("joints"), where, folder, limits.start);
  } else {
    limits.start = read_start(options, limits.pose);
  }
  check_start(limits, options);
  options.finish();
  return limits;
}

Json to_json(const Limits& limits) {
  Json json{{"rate_hz", limits.rate_hz}};
  const char* const groups[] = {"position_m", "angle_rad"};
  const char* const names[] = {"x", "y", "z", "alpha", "beta", "gamma"};
  for (std::size_t k = 0; k < 6; ++k) {
    json[groups[k / 3]][names[k]] = {limits.pose.range[k].low, limits.pose.range[k].high};
  }
  const auto add = [&](const char* key, double value) {
    if (std::isfinite(value)) json[key] = value;
  };
  add("speed_mps", limits.pose.speed);
  add("acceleration_mps2", limits.pose.acceleration);
  add("jerk_mps3", limits.pose.jerk);
  add("rate_radps", limits.pose.rate);
  add("acceleration_radps2", limits.pose.angular_acceleration);
  add("jerk_radps3", limits.pose.angular_jerk);
  const Eigen::VectorXd& s = limits.start;
  json["start"] = {{"position_m", {s(0), s(1), s(2)}}, {"angle_rad", {s(3), s(4), s(5)}}};
  return json;
}

Limits read_limits(const std::filesystem::path& path) {
  return parse_limits(read_json(path, Exit::kUsage), path.string(), path.parent_path());
}

}  // namespace dcnn::design
