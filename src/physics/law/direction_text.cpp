// SPDX-License-Identifier: Apache-2.0
#include "physics/law/direction_text.h"

#include "dcnn/core/number.h"

namespace dcnn::law {
namespace {

/// Place of the first number of the direction itself.
Eigen::Index own_place(const Structure& structure) {
  return *directions()[structure.direction].unit ? 2 : 1;
}

std::string frame_of(const Structure& structure) {
  const std::string name = directions()[structure.direction].name;
  return name.find("base") != std::string::npos ? "base" : "sensor";
}

/// Whether the force changes its sign with the coordinate that is the rate along its own axis.
bool is_resistance(const Structure& structure) {
  if (structure.factors.empty()) return false;
  const std::string axis = directions()[structure.direction].name;
  const std::string q = coordinates()[structure.factors[0].coordinate].name;
  const std::string shape = shapes()[structure.factors[0].shape].name;
  const bool odd = shape == "linear" || shape == "power" || shape == "asymmetric" ||
                   shape == "tanh" || shape == "peaked" || shape == "fading" ||
                   shape == "dead_band" || shape == "log";
  const bool along = q == "v_along" && is_axis(structure.direction);
  return odd && (along || q == "v_" + axis || (q == "speed" && axis == "along_velocity"));
}

/// Of a machine's axis.
std::string axis_beginning(const Law& law, const Terms& terms) {
  const double sign = law.numbers(0) * terms.resisting;
  if (is_resistance(law.structure)) {
    return std::string("an effort ") + (sign > 0.0 ? "against" : "with") + " the motion of " +
           terms.axis;
  }
  return std::string("an effort ") + (law.numbers(0) < 0.0 ? "missing from" : "added to") +
         " that of " + terms.axis;
}

}  // namespace

std::string own_text(const Law& law) {
  if (own_numbers(law.structure) == 0) return "";
  const Vector3d own = own_vector(law.structure, &law.numbers(own_place(law.structure)));
  return "(" + brief(own[0]) + ", " + brief(own[1]) + ", " + brief(own[2]) + ")";
}

std::string direction_words(const Law& law) {
  const Structure& structure = law.structure;
  const std::string words = directions()[structure.direction].words, own = own_text(law);
  if (is_central(structure.direction)) return "the line from the point " + own + " m";
  if (!structure.oblique) return words;
  const std::string axis = "the axis " + own + " of the " + frame_of(structure);
  const auto cut = words.find(" and ");  // of a vector product
  return cut == std::string::npos ? axis : words.substr(0, cut + 5) + axis;
}

std::string direction_name(const Law& law) {
  const Structure& structure = law.structure;
  const std::string name = directions()[structure.direction].name, own = own_text(law);
  if (is_central(structure.direction)) return name + own;
  if (!structure.oblique) return name;
  const auto cut = name.find("cross_");
  return (cut == std::string::npos ? "" : name.substr(0, cut + 6)) + frame_of(structure) + own;
}

std::string beginning_words(const Law& law, const Terms& terms) {
  if (!terms.axis.empty()) return axis_beginning(law, terms);
  const bool negative = law.numbers(0) < 0.0;
  const Direction& direction = directions()[law.structure.direction];
  std::string text = law.structure.on_torque ? "a torque " : "a force ";
  if (is_resistance(law.structure)) {
    text += negative ? "against the motion along " : "with the motion along ";
    const bool path = std::string(direction.name) == "along_velocity";
    return text + (path ? "its path" : direction_words(law));
  }
  if (is_central(law.structure.direction)) {
    return text + (negative ? "towards" : "away from") + " the point " + own_text(law) +
           " m of the base";
  }
  return text + (negative ? "against " : "along ") + direction_words(law);
}

}  // namespace dcnn::law
