// SPDX-License-Identifier: Apache-2.0
#include "physics/found_numbers.h"

#include <algorithm>
#include <cmath>

#include "dcnn/core/number.h"

namespace dcnn {
namespace {

constexpr double kSmall = 0.01;  // N, N·m: below it thousandths are read more easily

std::string torque_text(double newton_metres) {
  return std::abs(newton_metres) < kSmall ? in_thousandths(newton_metres, "mN·m")
                                          : brief(newton_metres) + " N·m";
}

}  // namespace

std::string in_thousandths(double value, const std::string& unit) {
  return brief(1e3 * value) + " " + unit;
}

std::string mass_text(double kg) {
  return std::abs(kg) < 1.0 ? in_thousandths(kg, "g") : brief(kg) + " kg";
}

std::string force_text(double newtons) {
  return std::abs(newtons) < kSmall ? in_thousandths(newtons, "mN") : brief(newtons) + " N";
}

const FoundNumber* FoundNumbers::find(const std::string& stem) const {
  const auto found = std::find_if(numbers_.begin(), numbers_.end(),
                                  [&](const FoundNumber& number) { return number.stem == stem; });
  return found == numbers_.end() ? nullptr : &*found;
}

double FoundNumbers::value(const std::string& stem) const {
  const FoundNumber* number = find(stem);
  return number ? number->value : 0.0;
}

std::string FoundNumbers::unit(const std::string& stem) const {
  const FoundNumber* number = find(stem);
  return number ? number->unit : "";
}

bool FoundNumbers::is_told(const std::string& stem) const {
  const FoundNumber* number = find(stem);
  return !number || number->is_told;
}

bool FoundNumbers::holds(const std::string& stem, double at) const {
  const FoundNumber* number = find(stem);
  return number && number->low <= at && number->high >= at;
}

double FoundNumbers::length(const std::string& begin, const std::string& unit) const {
  double square = 0.0;
  for (const FoundNumber& number : numbers_) {
    if (number.stem.starts_with(begin) && number.unit == unit) {
      square += number.value * number.value;
    }
  }
  return std::sqrt(square);
}

std::string FoundNumbers::operator()(const std::string& stem) const {
  return plain(stem) + " " + unit(stem);
}

std::string FoundNumbers::plain(const std::string& stem, double factor) const {
  return brief(factor * value(stem));
}

std::string FoundNumbers::size(const std::string& stem, double factor,
                               const std::string& per) const {
  return brief(std::abs(factor * value(stem))) + " " + unit(stem) + (per.empty() ? "" : "/" + per);
}

std::string FoundNumbers::push(const std::string& begin, const std::string& per,
                               double times) const {
  const double force = times * length(begin, "N" + per),
               torque = times * length(begin, "N·m" + per);
  if (torque == 0.0) return force_text(force);
  return force == 0.0 ? torque_text(torque) : force_text(force) + " and " + torque_text(torque);
}

}  // namespace dcnn
