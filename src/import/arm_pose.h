// SPDX-License-Identifier: Apache-2.0
// The pose of an arm's link from its joint angles.
#pragma once

#include "import/stream_table.h"

namespace dcnn {

/// Replaces columns q:NAME by x,y,z,qw,qx,qy,qz of rule.link in rule.base, by the URDF.
void pose_from_joints(const ArmRule& rule, StreamTable* table, const std::string& file);

}  // namespace dcnn
