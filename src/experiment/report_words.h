// SPDX-License-Identifier: Apache-2.0
// What reports call things: effects, axes and parameters in words, numbers in units people use.
#pragma once

#include <string>

namespace dcnn {

/// "friction force" for "fc_n", "centre of mass off by, x" for "delta_com_x_m" of this effect;
/// "friction force of dry friction" for "coulomb_friction.fc_n".
std::string words_of_parameter(const std::string& effect, const std::string& name);
/// "velocity along the tool" for "v_z": a signal of where.regimes; another one's name as it is.
std::string words_of_signal(const std::string& signal);
/// "own numbers" for "parameter": the kinds of a difference in where.budget.
std::string words_of_part(const std::string& part);
/// The unit to give the two below for a parameter: shares without a unit are shown in per cent.
std::string unit_in_words(const std::string& effect, const std::string& name,
                          const std::string& unit);
/// "3.2 g" for 0.0032 kg, "402 mN" or "0.402 N"; three digits.
std::string with_unit(double value, const std::string& unit);
/// The same for a value and its interval, in one unit: "0.402 N (0.398 to 0.406)"; without an
/// interval that three digits do not show.
std::string with_interval(double value, double low, double high, const std::string& unit);

}  // namespace dcnn
