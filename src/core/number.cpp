#include "dcnn/core/number.h"

#include <cstdio>

namespace dcnn {

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace dcnn
