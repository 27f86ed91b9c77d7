// SPDX-License-Identifier: Apache-2.0
// Numbers and units as sentences show them.
#pragma once

#include <string>

namespace dcnn {

/// Three significant digits: "0.0412", "1230", "1.23e+06".
std::string brief(double value);

/// Whether a finite number has at most two significant digits, as commands that people choose have.
bool has_two_digits(double value);

/// A unit as people write it: "N·m" for "N*m", "N·s²/m²" for "N*s^2/m^2", "°C" for "degC".
std::string unit_text(const std::string& unit);

}  // namespace dcnn
