// Units of the columns that a log is to become.
#pragma once

#include "dcnn/import/recipe.h"

namespace dcnn {

/// "force", "length", … of a column or working name; empty where any number may stand there.
std::string quantity_of_column(const std::string& to);

/// Fills unit, why, gain, offset and wrap of every column: what the user says, the channel's name,
/// the type of the message, its size; what only its size tells is a question.
void propose_units(const ForeignLog& log, const ImportWishes& wishes, Proposal* proposal);

}  // namespace dcnn
