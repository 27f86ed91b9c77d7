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

}  // namespace dcnn
