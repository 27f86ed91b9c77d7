// SPDX-License-Identifier: Apache-2.0
#include "physics/law/factor_text.h"

#include "dcnn/core/number.h"

namespace dcnn::law {
namespace {

/// Unit of the path that a coordinate's displacements make.
std::string path_unit(const Coordinate& q) {
  const std::string unit = q.unit;
  return q.is_rate ? unit.substr(0, unit.find('/')) : unit;
}

}  // namespace

std::vector<FactorText> texts_of(const Law& law, const Terms& terms) {
  const auto list = numbers_of(law.structure, terms);
  const Terms here = with_signals(terms, law.structure.signals);
  std::vector<FactorText> texts;
  for (std::size_t k = 0; k < law.structure.factors.size(); ++k) {
    const Factor& factor = law.structure.factors[k];
    FactorText text{&factor, &shapes()[factor.shape], here.coordinates[factor.coordinate],
                    std::to_string(k + 1)};
    for (std::size_t i = 0; i < list.size(); ++i) {
      const double value = law.numbers(static_cast<Eigen::Index>(i));
      const std::string& unit = list[i].unit;
      const std::string told = brief(value) + (unit.empty() ? "" : " " + unit);
      const auto begins = [&](const std::string& stem) {
        return list[i].name == stem + text.index ||
               list[i].name.starts_with(stem + text.index + "_");
      };
      if (begins("memory_")) text.memory = told;
      for (const char* stem : {"damping_", "recovery_", "spread_", "falling_"}) {
        if (begins(stem)) text.second = told;
      }
      if (begins("centre_")) text.centre = told, text.centre_value = value;
      if (begins("scale_")) text.scale = told, text.scale_value = value;
      if (begins("power_") || begins("ratio_") || begins("gain_")) text.extra = value;
      if (begins("value_")) text.curve.push_back(value);
    }
    texts.push_back(text);
  }
  return texts;
}

std::string state_unit(const Factor& factor, const Coordinate& q) {
  if (factor.memory == Memory::kDahl || factor.memory == Memory::kStop ||
      factor.memory == Memory::kThixotropic) {
    return "";
  }
  if (factor.memory == Memory::kDwell) return "s";
  return q.unit;
}

std::string memory_unit(const Factor& factor, const Coordinate& q) {
  if (factor.memory == Memory::kPlay || factor.memory == Memory::kPlays) return q.unit;
  if (factor.memory == Memory::kDahl || factor.memory == Memory::kStop ||
      factor.memory == Memory::kDwell || factor.memory == Memory::kThixotropic) {
    return path_unit(q);
  }
  if (factor.memory == Memory::kSecondOrder) return "Hz";
  return "s";
}

double place(const FactorText& text, std::size_t node) {
  const double u = 2.0 * static_cast<double>(node) / static_cast<double>(text.curve.size() - 1) - 1;
  return text.centre_value + u * text.scale_value;
}

std::string amplitude_unit(const Law& law, const Terms& terms) {
  return law.structure.on_torque ? "N*m" : terms.force;
}

}  // namespace dcnn::law
