// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/number.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace dcnn {

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  const double rounded = std::strtod(text, nullptr);
  if (std::abs(rounded) < 1e3 || !(std::abs(rounded) < 1e6)) return text;
  std::snprintf(text, sizeof text, "%.0f", rounded);  // without an exponent
  return text;
}

bool has_two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return std::strtod(text, nullptr) == value;
}

std::string unit_text(const std::string& unit) {
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const std::string two = unit.substr(i, 2);
    if (two == "^2" || two == "^3") {
      text += two == "^2" ? "²" : "³";
      ++i;
    } else {
      text += unit[i] == '*' ? "·" : std::string(1, unit[i]);
    }
  }
  return text == "degC" ? "°C" : text;
}

}  // namespace dcnn
