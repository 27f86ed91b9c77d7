// Numbers as sentences show them.
#pragma once

#include <string>

namespace dcnn {

/// Three significant digits: "0.0412", "1.2e+03".
std::string brief(double value);

}  // namespace dcnn
