// SPDX-License-Identifier: Apache-2.0
// What a logged pose must satisfy before anything is computed from it.
#pragma once

#include "dcnn/data/recording.h"

namespace dcnn {

/// Refuses degrees, millimetres and quaternions off the unit sphere (by more than 1e-3), each with
/// its remedy; `file` is named in errors.
void check_pose(const Recording& recording, const std::string& file);

/// Unwraps angles and chooses between q and -q, so that the columns may be interpolated.
void make_continuous(Recording& recording);

/// Scales logged quaternions to length 1.
void normalise_quaternions(Recording& recording);

}  // namespace dcnn
