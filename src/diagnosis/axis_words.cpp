// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/axis_words.h"

#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/effect.h"
#include "dcnn/physics/effect_words.h"
#include "diagnosis/plain_findings.h"
#include "diagnosis/words.h"

namespace dcnn {

std::string axis_words(const Json& finding, const Axis& axis, const std::string& strength) {
  const std::string id = finding["effect"];
  const Json& numbers = finding["parameters"];
  if (numbers.contains("driven_by")) {
    const auto low = finding["driven_over"][0].get<double>(),
               high = finding["driven_over"][1].get<double>();
    const auto at = [&](double s) {
      return numbers[strength]["value"].get<double>() + s * numbers["slope"]["value"].get<double>();
    };
    return driven_words(*find_effect(id), "",
                        {numbers["driven_by"]["value"], unit_text(numbers[strength]["unit"]), low,
                         high, at(low), at(high), numbers["lag"]["value"]}) +
           " on " + axis.name;
  }
  if (is_constant(finding)) return constant_words(finding) + " on " + axis.name;
  const EffectKind* kind = find_effect(id);
  const std::string what = kind && kind->words ? kind->words(found_numbers(numbers, true))
                                               : words_of_effect(id, axis.name);
  return what + " on " + axis.name;
}

std::string reaction_words(const Axis& axis) {
  return axis.name + ": what is measured opposes the motion" +
         (axis.simulated.empty()
              ? " and is taken for the reaction to the drive"
              : " beside what is simulated: friction takes from the reading, as of an output "
                "behind it, or it is the reaction to the drive") +
         " (\"measured\": \"reaction\" in model.json)";
}

}  // namespace dcnn
