// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {

/// Found with the other readings of a wrist's torque; see torque_axes.cpp.
const FaultKind torque_frame_fault{
    "torque_frame",
    true,
    "log force and torque in one frame, that of the sensor, or turn the torque by the pose",
    "",
    nullptr,
    nullptr,
    true};

}  // namespace dcnn::check
