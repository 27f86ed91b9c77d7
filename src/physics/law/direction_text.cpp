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

}  // namespace dcnn::law
