// Numbers as sentences show them.
#pragma once

#include <string>

namespace dcnn {

/// Three significant digits: "0.0412", "1230", "1.23e+06".
std::string brief(double value);

}  // namespace dcnn
