// SPDX-License-Identifier: Apache-2.0
// Text for SVG and HTML, the same under every locale.
#pragma once

#include <string>
#include <vector>

namespace dcnn {

/// Text safe inside elements and attributes; control characters that XML forbids become U+FFFD.
std::string escape_markup(const std::string& text);

/// `digits` significant digits, "–" for what is not finite.
std::string significant(double value, int digits);

/// A fixed number of decimals, never "-0".
std::string fixed(double value, int decimals);

/// Decimals with which the least of these sizes has `digits` significant digits, 9 at most; zeros
/// and what is not finite do not count. Numbers of one column have the same.
int common_decimals(const std::vector<double>& values, int digits);

/// "97 %", "0.71 %", "< 0.01 %" for a share.
std::string percent(double share);

/// Filled with spaces to `width` characters.
std::string padded(std::string text, std::size_t width);

/// Characters of a UTF-8 text.
int character_count(const std::string& text);

}  // namespace dcnn
