// SPDX-License-Identifier: Apache-2.0
// What was found in a log, for people and for programs.
#pragma once

#include <string>

#include "dcnn/core/json.h"
#include "dcnn/data/csv.h"
#include "dcnn/import/recipe.h"

namespace dcnn {

/// A table of streams, clocks and channels; channels that become nothing are listed shortly.
std::string describe(const ForeignLog& log, const Recipe& recipe);
Json describe_json(const ForeignLog& log, const Proposal& proposal);

/// What a shell takes as this one word: in quotes where it must be.
std::string quoted_argument(const std::string& word);

/// The description of an arm for --system, from columns q_NAME, qd_NAME and tau_NAME; null where
/// the recording is of a wrist.
Json axes_of(const Table& table, const Recipe& recipe);

}  // namespace dcnn
