// SPDX-License-Identifier: Apache-2.0
// The numbers of a law's factors as texts with units, for its formula and its words.
#pragma once

#include <string>
#include <vector>

#include "dcnn/physics/law.h"

namespace dcnn::law {

/// The numbers of one factor as texts with units.
struct FactorText {
  const Factor* factor;
  const Shape* shape;
  Coordinate q;
  std::string index = {}, memory = {}, second = {}, centre = {}, scale = {};
  double centre_value = 0.0, scale_value = 1.0, extra = 0.0;
  std::vector<double> curve = {};  // values at its nodes
};

/// One per factor.
std::vector<FactorText> texts_of(const Law& law, const Terms& terms);
/// Unit of what the shape is taken of.
std::string state_unit(const Factor& factor, const Coordinate& q);
/// Unit of the size of what a coordinate drives.
std::string memory_unit(const Factor& factor, const Coordinate& q);
/// Place of a node of a curve, in the unit of what the curve is taken of.
double place(const FactorText& text, std::size_t node);
/// "N", "N*m", or that of a machine's drive.
std::string amplitude_unit(const Law& law, const Terms& terms);

}  // namespace dcnn::law
