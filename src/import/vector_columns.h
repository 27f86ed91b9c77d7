// SPDX-License-Identifier: Apache-2.0
// Columns of forces, positions and orientations by the names of a log's channels.
#pragma once

#include <string>
#include <vector>

#include "dcnn/import/recipe.h"

namespace dcnn {

/// "STREAM:CHANNEL", or a channel's name that one stream alone has; else an Error(kUsage).
ColumnRule find_channel(const ForeignLog& log, const std::string& spec);

/// Adds to the proposal's columns, in which what --map says is already, the vectors that are known
/// by their names: of the streams of --use where one of them has such a vector. What several
/// streams or channels may be is a question.
void find_vectors(const ForeignLog& log, const ImportWishes& wishes, Proposal* proposal);

/// Takes a pose that --map does not name off a proposal in which joints have torques and no force
/// stands: it says nothing there that the angles do not.
void leave_pose_of_arm(const ImportWishes& wishes, Proposal* proposal);

/// The four channels, counted on, whose squares sum up to 1 in every row: a quaternion by index, in
/// their order. Empty where there are none, or several.
std::vector<ColumnRule> find_unit_quaternion(const ForeignLog& log);

}  // namespace dcnn
