// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>

#include "conceal/axis_draw.h"
#include "dcnn/conceal/axis.h"
#include "dcnn/core/error.h"

namespace dcnn::conceal {
namespace {

/// Effects that occur together in machines.
const std::vector<std::string>& axis_pairs() {
  static const std::vector<std::string> all{"coulomb_friction+viscous_friction",
                                            "coulomb_friction+gain",
                                            "coulomb_friction+cable_spring",
                                            "coulomb_friction+time_delay",
                                            "coulomb_friction+bias",
                                            "coulomb_friction+cogging",
                                            "viscous_friction+cogging",
                                            "lugre_friction+viscous_friction",
                                            "viscous_friction+thermal_drift",
                                            "stribeck_friction+inertia",
                                            "hysteresis+viscous_friction",
                                            "viscous_friction+lowpass",
                                            "inertia+viscous_friction",
                                            "coulomb_friction+hum",
                                            "coulomb_friction+linear_drift",
                                            "cable_spring+cubic_spring"};
  return all;
}
const std::vector<std::string>& axis_triples() {
  static const std::vector<std::string> all{
      "coulomb_friction+viscous_friction+cogging",      "coulomb_friction+viscous_friction+bias",
      "coulomb_friction+viscous_friction+cable_spring", "coulomb_friction+viscous_friction+gain",
      "coulomb_friction+viscous_friction+time_delay",   "coulomb_friction+cable_spring+bias"};
  return all;
}

/// Effects that keep their meaning beside a column whose unit is not known.
std::vector<std::string> effects_beside_scale() {
  std::vector<std::string> all = axis_catalogue();
  std::erase_if(all, [](const std::string& e) {
    return axis_class(e) != "friction" && axis_class(e) != "spring" && axis_class(e) != "offset" &&
           axis_class(e) != "ripple";
  });
  std::erase(all, "load_friction");
  return all;
}

/// Each law beside a listed effect of another kind.
std::vector<std::string> laws_beside_effects() {
  std::vector<std::string> all;
  for (const std::string& law : axis_laws()) {
    all.push_back(law + (axis_class(law) == "friction" ? "+cogging" : "+coulomb_friction"));
  }
  return all;
}

const std::vector<Share>& axis_shares() {
  static const std::vector<std::string> strengths{"1", "3", "10"};
  static const std::vector<Share> all{{"null", 0.15, {"0"}, {"none"}},
                                      {"weak", 0.12, {"0.3"}, axis_catalogue()},
                                      {"single", 0.33, strengths, axis_catalogue()},
                                      {"double", 0.12, strengths, axis_pairs()},
                                      {"triple", 0.05, strengths, axis_triples()},
                                      {"scaled", 0.04, strengths, effects_beside_scale()},
                                      {"unlisted", 0.13, strengths, axis_laws()},
                                      {"mixed", 0.06, strengths, laws_beside_effects()}};
  return all;
}

}  // namespace

std::vector<std::string> axis_plan(int scenarios, std::uint64_t seed) {
  Rng rng({seed, 32});
  return plan_of(axis_shares(), scenarios, rng);
}

AxisRequest parse_axis_id(const std::string& id) {
  const auto colon = id.find(':'), first = id.find('/'), second = id.rfind('/');
  require(colon < first && first < second, Exit::kUsage, id, ": write group:from/effects/number");
  AxisRequest r;
  r.group = id.substr(0, colon);
  const std::string from = id.substr(colon + 1, first - colon - 1);
  std::from_chars(from.data(), from.data() + from.size(), r.from);
  const bool known = has("null weak single double triple scaled unlisted mixed", r.group);
  require(known, Exit::kUsage, id, ": no group of axes is called ", r.group);
  if (r.group == "null") return r;
  require(r.from > 0.0 && r.from < 1e6, Exit::kUsage, id, ": '", from,
          "' is no strength; write a positive number, as in single:3/cogging/7");
  std::string list = id.substr(first + 1, second - first - 1) + "+";
  for (auto plus = list.find('+'); plus != list.npos; plus = list.find('+')) {
    const std::string effect = list.substr(0, plus);
    require(!axis_class(effect).empty(), Exit::kUsage, id, ": no effect of an axis is called ",
            effect);
    r.effects.push_back(effect);
    list.erase(0, plus + 1);
  }
  return r;
}

}  // namespace dcnn::conceal
