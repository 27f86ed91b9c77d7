// SPDX-License-Identifier: Apache-2.0
#include "data/pose_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/data/rotation.h"

namespace dcnn {
namespace {

using Names = std::vector<std::string>;

constexpr double kNormTolerance = 1e-3;
constexpr double kMaxTurn = 8.0 * std::numbers::pi;   // rad; no cabled wrist turns four times
constexpr double kMaxPitch = 2.0 * std::numbers::pi;  // rad; beta does not wind up
constexpr double kMaxReach = 100.0;                   // m
constexpr double kMaxSpeed = 20.0;                    // m/s

void check_quaternions(const Recording& recording, const std::string& file) {
  const Eigen::VectorXd norm = recording.block(kQuaternion).rowwise().norm();
  for (Index i = 0; i < norm.size(); ++i) {
    require(std::abs(norm[i] - 1.0) <= kNormTolerance, Exit::kData, file, ":", i + 2,
            ": quaternion of length ", norm[i],
            " instead of 1; repair the log or check the order qw,qx,qy,qz");
  }
}

void check_radians(const Recording& recording, const std::string& file) {
  for (const std::string& name : kEuler) {
    const Eigen::VectorXd angle = recording.column(name);
    const double limit = name == "beta" ? kMaxPitch : kMaxTurn;
    for (Index i = 0; i < angle.size(); ++i) {
      require(std::abs(angle[i]) <= limit, Exit::kData, file, ":", i + 2, ": column '", name,
              "' is ", angle[i],
              " rad, beyond any wrist; if the log is in degrees, use --angle-unit deg");
    }
  }
}

double median_speed(const Recording& recording, const Eigen::MatrixXd& position) {
  std::vector<double> speeds;
  for (const Segment& segment : recording.segments) {
    for (Index i = segment.begin + 1; i < segment.end; ++i) {
      speeds.push_back((position.row(i) - position.row(i - 1)).norm() / recording.dt);
    }
  }
  if (speeds.empty()) return 0.0;
  const auto middle = speeds.begin() + static_cast<Index>(speeds.size() / 2);
  std::nth_element(speeds.begin(), middle, speeds.end());
  return *middle;
}

void check_metres(const Recording& recording, const std::string& file) {
  const Eigen::MatrixXd position = recording.block(kPosition);
  for (Index i = 0; i < position.rows(); ++i) {
    Index k = 0;
    const double far = position.row(i).cwiseAbs().maxCoeff(&k);
    require(far <= kMaxReach, Exit::kData, file, ":", i + 2, ": column '",
            kPosition[static_cast<std::size_t>(k)], "' is ", position(i, k),
            " m, beyond any robot; if the log is in millimetres, use --position-unit mm");
  }
  const double speed = recording.dt > 0.0 ? median_speed(recording, position) : 0.0;
  require(speed <= kMaxSpeed, Exit::kData, file, ": the median speed of x,y,z is ", speed,
          " m/s, beyond any robot; if the log is in millimetres, use --position-unit mm");
}

void set_block(Recording& recording, const Names& columns, const Eigen::MatrixXd& values) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    recording.set(columns[k], values.col(static_cast<Index>(k)));
  }
}

}  // namespace

void check_pose(const Recording& recording, const std::string& file) {
  if (recording.has_all(kPosition)) check_metres(recording, file);
  if (recording.has_all(kEuler)) check_radians(recording, file);
  if (recording.has_all(kQuaternion)) check_quaternions(recording, file);
}

void make_continuous(Recording& recording) {
  if (recording.has_all(kQuaternion)) set_block(recording, kQuaternion, quaternions(recording));
  if (!recording.has_all(kEuler)) return;
  Eigen::MatrixXd euler = recording.block(kEuler);
  unwrap(euler);
  set_block(recording, kEuler, euler);
}

void normalise_quaternions(Recording& recording) {
  if (!recording.has_all(kQuaternion)) return;
  set_block(recording, kQuaternion, recording.block(kQuaternion).rowwise().normalized());
}

}  // namespace dcnn
