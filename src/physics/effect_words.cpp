// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/effect_words.h"

#include <algorithm>

#include "dcnn/physics/effect.h"

namespace dcnn {

std::string words_of_effect(const std::string& name, const std::string& axis) {
  const EffectKind* kind = find_effect(name);
  const bool on_machine = !axis.empty() && words_of_axis(axis) == axis;
  if (kind && on_machine && kind->on_machine) return kind->on_machine;
  if (kind && kind->meaning) return kind->meaning;
  std::string words = name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string words_of_axis(const std::string& axis) {
  if (axis == "tool_z") return "along the tool";
  const auto colon = axis.find(':');
  if (colon != axis.npos) {
    return words_of_axis(axis.substr(colon + 1)) + ", by the angle " + axis.substr(0, colon);
  }
  for (const auto& [start, words] :
       {std::pair{"base_", "along the base's "}, std::pair{"sensor_", "along the sensor's "},
        std::pair{"w_sensor_", "against turning about the sensor's "}}) {
    const std::string begin = start;
    if (axis.starts_with(begin) && axis.size() == begin.size() + 1) {
      return words + axis.substr(begin.size()) + " axis";
    }
  }
  return axis;
}

std::string words_of_structure(const std::string& names) {
  static const std::string kAnd = " + ";
  const auto end = names.find(kAnd);
  if (end != names.npos) {
    return words_of_structure(names.substr(0, end)) + " and " +
           words_of_structure(names.substr(end + kAnd.size()));
  }
  const auto space = names.find(' ');
  if (space == names.npos) return words_of_effect(names);
  const std::string axis = names.substr(space + 1);
  return words_of_effect(names.substr(0, space), axis) + " " + words_of_axis(axis);
}

}  // namespace dcnn
