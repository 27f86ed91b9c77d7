// SPDX-License-Identifier: Apache-2.0
// Units of the columns that a log is to become.
#pragma once

#include "dcnn/import/recipe.h"

namespace dcnn {

/// "force", "length", … of a column or working name; empty where any number may stand there.
std::string quantity_of_column(const std::string& to);

/// Whether a column of a joint (q:NAME, qd:NAME, tau:NAME) in units of `quantity` is one of an axis
/// that slides: a length, a velocity, a force.
bool is_of_sliding_axis(const std::string& to, const std::string& quantity);

/// Fills unit, why, gain, offset and wrap of every column: what the user says, the channel's name,
/// the type of the message, its size; what only its size tells is a question.
void propose_units(const ForeignLog& log, const ImportWishes& wishes, Proposal* proposal);

}  // namespace dcnn
