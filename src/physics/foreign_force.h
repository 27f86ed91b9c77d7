// SPDX-License-Identifier: Apache-2.0
// How much of a measured force is not the tool's.
#pragma once

#include <string>

namespace dcnn {

/// Share of the force's power about its mean that neither a rigid tool nor the sensor's noise
/// makes, from three sums of squares (N^2); 0 for a force that never changes.
double foreign_share(double residual, double noise, double force);

/// A sentence where more than half of the force is foreign, ended by `conclusion`; else nothing.
/// `what` is not the model's.
std::string foreign_force_note(
    double share, const std::string& conclusion,
    const std::string& what = "what the force varies by is no rigid tool's");

}  // namespace dcnn
