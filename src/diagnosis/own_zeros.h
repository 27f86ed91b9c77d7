// SPDX-License-Identifier: Apache-2.0
// A sensor's zero that is another one in each recording.
#pragma once

#include <optional>
#include <string>

#include "diagnosis/search.h"

namespace dcnn {

/// How far the zeros of the fitted recordings lie apart, in words, of the channel where that is
/// most beside its noise; nothing where the search has not taken them to differ.
std::optional<std::string> note_of_zeros(const Search& search);

}  // namespace dcnn
