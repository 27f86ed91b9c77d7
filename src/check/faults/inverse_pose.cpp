// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

void inverse_poses(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.is_wrist()) return;
  Reading reading = base;
  reading.orientation.inverse = !base.orientation.inverse;
  reading.orientation.inverse_position = false;
  reading.channel = log.has_quaternion() ? "qw" : "alpha";
  reading.words = "the orientation is inverted: of the base in the pose frame";
  out.push_back(reading);
  if (!reading.orientation.inverse || !log.has_all(kPosition)) return;
  reading.orientation.inverse_position = true;
  reading.words = "the pose is inverted: orientation and position of the base in the pose frame";
  out.push_back(reading);
}

}  // namespace

const FaultKind inverse_pose_fault{
    "inverse_pose",
    true,
    "invert the orientation (conjugate the quaternion), and the position with it: x = -R x_logged",
    "",
    nullptr,
    inverse_poses,
    true};

}  // namespace dcnn::check
