// SPDX-License-Identifier: Apache-2.0
// Text from files we do not trust.
#pragma once

#include <string>
#include <string_view>

namespace dcnn {

/// Up to 40 bytes of `text` in quotes, with what does not print replaced: safe in a one-line
/// message.
std::string shown(std::string_view text);

/// Without the spaces around.
std::string_view trimmed(std::string_view text);

bool is_utf8(std::string_view text);

}  // namespace dcnn
