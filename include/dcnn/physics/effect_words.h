// SPDX-License-Identifier: Apache-2.0
// What the catalogue's names are called in reports.
#pragma once

#include <string>

namespace dcnn {

/// "dry friction" for "coulomb_friction"; of any other name the name with spaces. Along an axis that
/// is a machine's own as it is called there: "spring over the position" for "cable_spring".
std::string words_of_effect(const std::string& name, const std::string& axis = "");
/// "along the tool" for "tool_z"; the name itself where it is a machine's own, empty for "".
std::string words_of_axis(const std::string& axis);
/// "dry friction along the tool and scale error per axis" for "coulomb_friction tool_z + gain".
std::string words_of_structure(const std::string& names);

}  // namespace dcnn
