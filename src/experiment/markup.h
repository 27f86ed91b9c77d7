// Text for SVG and HTML, the same under every locale.
#pragma once

#include <string>

namespace dcnn {

/// Text safe inside elements and attributes; control characters that XML forbids become U+FFFD.
std::string escape_markup(const std::string& text);

/// `digits` significant digits, "–" for what is not finite.
std::string significant(double value, int digits);

/// A fixed number of decimals, never "-0".
std::string fixed(double value, int decimals);

/// Filled with spaces to `width` bytes.
std::string padded(std::string text, std::size_t width);

/// Characters of a UTF-8 text.
int character_count(const std::string& text);

}  // namespace dcnn
