// SPDX-License-Identifier: Apache-2.0
// What a message shows of a text that comes from outside.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dcnn {

/// At most `most` bytes of `text`, cut between UTF-8 characters and ended by "..." where it is
/// longer; each control character (C0, DEL, C1, marks of direction: what a
/// terminal would obey) and each byte that is
/// not UTF-8 is shown as '?'.
std::string excerpt(std::string_view text, std::size_t most = 80);

/// Bytes of the UTF-8 character that a text which is not empty begins with (RFC 3629); 0 where it
/// begins with none.
std::size_t utf8_length(std::string_view text);

}  // namespace dcnn
