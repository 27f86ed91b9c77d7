// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

void base_frames(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.is_wrist() || base.force_in_base) return;
  Reading reading = base;
  reading.force_in_base = true;
  reading.channel = "fx";
  reading.words = "forces are in the robot's base frame, not in the sensor's";
  out.push_back(reading);
}

}  // namespace

const FaultKind base_frame_fault{
    "base_frame",
    true,
    "log the force as the sensor reads it, or turn it by the pose: dcnn-import LOG "
    "--wrench-frame base --out FOLDER",
    "",
    nullptr,
    base_frames,
    true};

}  // namespace dcnn::check
