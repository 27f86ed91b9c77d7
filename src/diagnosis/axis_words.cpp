#include "diagnosis/axis_words.h"

#include <limits>
#include <vector>

#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/effect.h"
#include "dcnn/physics/effect_words.h"
#include "diagnosis/plain_findings.h"
#include "diagnosis/words.h"
#include "physics/found_numbers.h"

namespace dcnn {
namespace {

/// Those with a value; a logged signal's name is none.
FoundNumbers found_numbers(const Json& parameters) {
  std::vector<FoundNumber> found;
  for (const auto& [name, number] : parameters.items()) {
    const auto end = [&](std::size_t k) {
      const Json& value = number["ci95"][k];
      return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
    };
    found.push_back({name, unit_text(number["unit"].get<std::string>()),
                     number["value"].get<double>(), end(0), end(1), is_told(number)});
  }
  return {std::move(found), true};
}

}  // namespace

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
  const std::string what =
      kind && kind->words ? kind->words(found_numbers(numbers)) : words_of_effect(id, axis.name);
  return what + " on " + axis.name;
}

}  // namespace dcnn
