// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "dcnn/physics/forward.h"

namespace dcnn {
namespace {

/// Whether a parameter varies with the numbers that are fitted; a scale that is fixed does not.
bool is_fitted(const EffectKind& kind, const Json& parameters, const std::string& key) {
  return std::any_of(kind.fits.begin(), kind.fits.end(), [&](const EffectFit& form) {
    const auto published = [&](double x) {
      return form.parameters(Eigen::VectorXd::Constant(form.amplitudes, x),
                             Eigen::VectorXd::Constant(Index(form.shapes.size()), x));
    };
    const Json one = published(0.3), other = published(0.4);
    return one.size() == parameters.size() && one.contains(key) && one.at(key) != other.at(key);
  });
}

}  // namespace

ForwardNumbers::ForwardNumbers(const AxisMachine& machine, std::size_t axis)
    : axis_(axis), coefficients_(machine.axes[axis].coefficients.size()) {
  const CorrectedAxis& own = machine.axes[axis];
  const Axis& description = machine.system.axes[axis];
  const auto base = base_names(machine.system, axis);
  for (const Index column : own.columns) names_.push_back(base[static_cast<std::size_t>(column)]);
  for (std::size_t e = 0; e < own.effects.size(); ++e) {
    const EffectKind& kind = *find_effect(own.effects[e].effect);
    const Json& parameters = own.effects[e].parameters;
    for (const auto& [key, value] : parameters.items()) {
      const auto published = axis_parameter(kind, key, description, own.sense);
      if (!published || !value.is_number() || !is_fitted(kind, parameters, key)) continue;
      places_.push_back({e, key, published->sign, published->shift});
      names_.push_back(std::string(kind.name) + " " + published->stem +
                       (published->unit.empty() ? "" : " [" + published->unit + "]"));
    }
  }
}

Eigen::VectorXd ForwardNumbers::values(const AxisMachine& machine) const {
  const CorrectedAxis& own = machine.axes[axis_];
  Eigen::VectorXd x(coefficients_ + Index(places_.size()));
  x.head(coefficients_) = own.coefficients;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Place& at = places_[k];
    x(coefficients_ + Index(k)) =
        at.sign * own.effects[at.effect].parameters.at(at.key).get<double>() + at.shift;
  }
  return x;
}

void ForwardNumbers::set(AxisMachine& machine, const Eigen::VectorXd& values) const {
  CorrectedAxis& own = machine.axes[axis_];
  own.coefficients = values.head(coefficients_);
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Place& at = places_[k];
    own.effects[at.effect].parameters[at.key] =
        (values(coefficients_ + Index(k)) - at.shift) / at.sign;
  }
}

}  // namespace dcnn
