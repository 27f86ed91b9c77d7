// SPDX-License-Identifier: Apache-2.0
#include "physics/axis_law.h"

#include "dcnn/physics/law.h"

namespace dcnn {
namespace {

law::Terms terms_of(const Axis& axis, double sense) {
  return law::axis_terms(axis.name, axis.unit, axis.position_unit, sense);
}

}  // namespace

Json outer_law(const EffectSpec& effect, const Axis& axis, double sense) {
  Options structure(effect.law, "law", Exit::kData);
  Options parameters(effect.parameters, "law", Exit::kData);
  law::Law law = law::parse_law(law::parse_structure(structure), parameters);
  law.numbers(0) *= -sense;
  const law::Terms terms = terms_of(axis, sense);
  return {{"effect", effect.effect},
          {"interval_s", nullptr},
          {"law", law::to_json(law, terms)},
          {"parameters", law::parameters_json(law, terms)}};
}
Json inner_law(const Json& entry, const Axis& axis, double sense, const std::string& where,
               Exit exit) {
  const law::Terms terms = terms_of(axis, sense);
  Options structure(entry.value("law", Json::object()), where + ": law", exit);
  Options parameters(entry["parameters"], where + ": parameters", exit);
  law::Law law = law::parse_law(law::parse_structure(structure, terms), parameters, terms);
  parameters.finish();
  law.numbers(0) *= -sense;
  Json inner = entry;
  inner["law"] = law::to_json(law);
  inner["parameters"] = law::parameters_json(law);
  return inner;
}

}  // namespace dcnn
