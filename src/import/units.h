// SPDX-License-Identifier: Apache-2.0
// Units of logs in SI.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace dcnn {

struct LogUnit {
  std::string quantity;  ///< "length", "angle", "force", "torque", "time", …
  double factor = 1.0;   ///< SI units in one of it
  double origin = 0.0;   ///< SI value of its zero (degC of 0 degF is -17.8)
};

/// "mN", "deg", "N*m", "counts"; nothing where it is not known.
std::optional<LogUnit> find_unit(std::string_view unit);

/// "N, mN, kN, …": those of a quantity, or all where it is empty.
std::string units_of(const std::string& quantity);

/// "N", "rad": the SI unit of a quantity; empty where it is not known.
std::string si_unit_of(const std::string& quantity);

/// The unit that a name ends with: "fx [N]", "Fx (mN)", "x/mm", "angle_deg"; empty where none.
std::string unit_of_name(std::string_view name);
/// What stands in brackets behind a name, "Fx (pound)", and is no unit known here; empty where
/// none.
std::string unknown_unit_of_name(std::string_view name);
/// The name without its unit.
std::string name_without_unit(std::string_view name);

}  // namespace dcnn
