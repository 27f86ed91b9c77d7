// SPDX-License-Identifier: Apache-2.0
// What a user's words for streams and clocks mean in a log.
#pragma once

#include "dcnn/import/recipe.h"

namespace dcnn {

/// The same wishes with each stream of --use by its own name, and with --map t=CHANNEL as --clock
/// CHANNEL. Arrays of one length are a stream that a reader has numbered (arrays2): it is found by
/// what its columns begin with (the name of an array, or of the group that holds it). The
/// Error(kUsage) of a word that is neither lists the streams with their columns.
ImportWishes resolved_wishes(const ForeignLog& log, ImportWishes wishes);

}  // namespace dcnn
