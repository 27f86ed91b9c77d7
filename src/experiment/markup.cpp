// SPDX-License-Identifier: Apache-2.0
#include "experiment/markup.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace dcnn {
namespace {

std::string to_text(double value, std::chars_format format, int precision) {
  char text[400];  // the longest double has 309 digits before its point
  const auto result = std::to_chars(text, text + sizeof text, value, format, precision);
  return {text, result.ptr};
}

}  // namespace

std::string escape_markup(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') {
          safe += "\uFFFD";
        } else {
          safe += c;
        }
    }
  }
  return safe;
}

std::string significant(double value, int digits) {
  return std::isfinite(value) ? to_text(value, std::chars_format::general, digits) : "–";
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  const auto text = to_text(value, std::chars_format::fixed, decimals);
  const bool zero = text.find_first_of("123456789") == text.npos;
  return zero && text.front() == '-' ? text.substr(1) : text;
}

int common_decimals(const std::vector<double>& values, int digits) {
  constexpr int kMost = 9;
  double least = INFINITY;
  for (const double value : values) {
    if (std::isfinite(value) && value != 0.0) least = std::min(least, std::abs(value));
  }
  if (!std::isfinite(least)) return 0;
  return std::clamp(digits - 1 - static_cast<int>(std::floor(std::log10(least))), 0, kMost);
}

std::string percent(double share) {
  const double value = 100.0 * share;
  if (value > 0.0 && value < 0.01) return "< 0.01 %";
  const int decimals = std::abs(value) >= 10.0 || value == 0.0 ? 0 : std::abs(value) >= 1.0 ? 1 : 2;
  return std::isfinite(value) ? fixed(value, decimals) + " %" : "–";
}

int character_count(const std::string& text) {
  return static_cast<int>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(std::string text, std::size_t width) {
  const auto length = static_cast<std::size_t>(character_count(text));
  return text + std::string(width - std::min(width, length), ' ');
}

}  // namespace dcnn
