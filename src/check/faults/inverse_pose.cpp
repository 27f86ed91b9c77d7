#include "check/kind.h"

namespace dcnn::check {
namespace {

void inverse_poses(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.is_wrist()) return;
  Reading reading = base;
  reading.orientation.inverse = !base.orientation.inverse;
  reading.channel = log.has_quaternion() ? "qw" : "alpha";
  reading.words = "the orientation is inverted: of the base in the pose frame";
  out.push_back(reading);
}

}  // namespace

const FaultKind inverse_pose_fault{"inverse_pose", true, "invert the orientation (conjugate the quaternion)", "",
                                   nullptr, inverse_poses, true};

}  // namespace dcnn::check
