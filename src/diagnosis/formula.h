// A formula for what no effect of the catalogue explains.
#pragma once

#include <optional>
#include <string>

#include "diagnosis/joint_fit.h"

namespace dcnn {

struct Formula {
  std::string text;    ///< "0.8 N/(m*rad) (x - 0.51)(beta + 0.02) along the sensor's x axis"
  double share = 0.0;  ///< of the excess over the noise that it takes off where it was not fitted
};

/// The polynomial of at most three terms, along one axis of sensor or base, that takes most off
/// what a fit leaves: powers and products of two of position, orientation, their rates, predicted
/// force and time, and signs of rates. None where it takes off less than half. Positions and angles
/// stand as deviations from the middle of their ranges.
std::optional<Formula> formula_of(const Setting& setting, const JointFit& fit);

/// The largest gain of one such term: some 15 where only noise is left, for the best of thousands.
double most_of_a_term(const Setting& setting, const JointFit& fit);

}  // namespace dcnn
