// SPDX-License-Identifier: Apache-2.0
// A signal in bins of the position, and the orders (periods a turn, or a metre) of lines in it.
#pragma once

#include <vector>

#include "diagnosis/chain.h"

namespace dcnn {

/// Sums of a signal times a weight, and of the weight's squares, in even bins of a position
/// [rad or m].
struct PositionBins {
  double low = 0.0, width = 1.0;
  Eigen::VectorXd sum, count;

  PositionBins(double low, double high, double width);
  void add(double position, double value, double square);
  Index size() const { return sum.size(); }
  double range() const { return width * static_cast<double>(size()); }
};

/// The order, in [least, highest), whose sine and cosine of the position explain most of the bins
/// beside a straight line in it; 0 where none does.
double best_order(const PositionBins& bins, double least, double highest);

/// Width of the bins of an axis [rad or m], so narrow that they hold all orders which the motion at
/// its speed makes of frequencies within its band.
double position_bin(const Case& study);

/// Periods that a force of the position completes within one recording, below which it is hardly
/// told from a spring or a drift.
constexpr double kFewestTurns = 0.7;

/// Periods of a variation that is called that of gears: once does not show that it repeats.
constexpr double kFewestRepeats = 2.0;

/// The lowest order in an angle (column of Motion::euler) that completes so many periods.
double least_order(const Case& study, int angle, double periods = kFewestTurns);

/// The highest order that is looked for in bins of this width [rad or m]: of a tool's angle that of
/// the catalogue, of an axis, which may be a linear one of any pitch, what the bins tell.
double highest_order(const Case& study, const ShapeParameter& order, double width);

/// Frequency [Hz] above `band_hz` up to which forces repeat with the position, as the cogging of a
/// motor that turns fast does; 0 where no line of the position stands out there. The speed is the
/// rms one, forces and positions are of the same recordings, every `dt` seconds.
double band_of_position_lines(const std::vector<Eigen::VectorXd>& forces,
                              const std::vector<Eigen::VectorXd>& positions, double dt,
                              double band_hz);

}  // namespace dcnn
