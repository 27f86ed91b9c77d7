// SPDX-License-Identifier: Apache-2.0
// A discovered law in the model.json of a machine: told in the terms of its axis.
#pragma once

#include "dcnn/data/system.h"
#include "dcnn/physics/effect.h"

namespace dcnn {

/// What the law of a chain (a force on a tool along x) adds to the reading of the axis, and back.
/// `sense` is -1 where the reading is the reaction to the drive.
Json outer_law(const EffectSpec& effect, const Axis& axis, double sense);
/// `entry` is that of a file, `where` it is for messages.
Json inner_law(const Json& entry, const Axis& axis, double sense, const std::string& where,
               Exit exit);

}  // namespace dcnn
