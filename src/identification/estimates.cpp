// SPDX-License-Identifier: Apache-2.0
#include "identification/estimates.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "dcnn/data/rotation.h"

namespace dcnn::identification {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using Value = std::function<double(const WristState&)>;

constexpr double kTail = 0.025;  // of a 95 % interval, on each side
const char* const kAxes[] = {"x", "y", "z"};
const char* const kSix[] = {"xx", "yy", "zz", "xy", "xz", "yz"};

Vector3d com_S(const WristState& s) { return s.R_SE * s.h / s.mass; }

Vector3d mounting_rpy(const WristState& s) {
  return euler_from_rotation(s.R_SE.transpose()).reverse();
}

/// The quantiles of draws, between neighbours in proportion.
double quantile(std::vector<double>& sorted, double p) {
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (place - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

IdentifiedNumber estimate(const std::string& name, const std::string& unit, const Value& value,
                  const WristState& point, const Draws& draws) {
  std::vector<double> values;
  const double at = value(point);
  const bool angle = unit == "rad";
  for (const WristState& state : draws.states) {
    const double v = value(state);
    values.push_back(angle ? nearest_turn(v, at) : v);
  }
  std::sort(values.begin(), values.end());
  return {name, unit, at, quantile(values, kTail), quantile(values, 1.0 - kTail)};
}

}  // namespace

const IdentifiedNumber* find_estimate(const std::vector<IdentifiedNumber>& estimates, const std::string& name) {
  const auto found = std::find_if(estimates.begin(), estimates.end(),
                                  [&](const IdentifiedNumber& e) { return e.name == name; });
  return found == estimates.end() ? nullptr : &*found;
}

std::vector<IdentifiedNumber> tool_estimates(const WristFit& fit, const WristState& point,
                                     const Draws& draws) {
  std::vector<IdentifiedNumber> all;
  const auto add = [&](const std::string& name, const std::string& unit, const Value& value) {
    all.push_back(estimate(name, unit, value, point, draws));
  };
  add("mass_kg", "kg", [](const WristState& s) { return s.mass; });
  for (Index i = 0; i < 3; ++i) {
    add(std::string("com_") + kAxes[i] + "_m", "m",
        [i](const WristState& s) { return com_S(s)[i]; });
  }
  for (Index i = 0; i < 6 && fit.layout.torque; ++i) {
    add(std::string("inertia_") + kSix[i] + "_kgm2", "kg*m^2", [i](const WristState& s) {
      return six_of(s.R_SE * s.inertia * s.R_SE.transpose())[i];
    });
  }
  for (Index i = 0; i < 3 && fit.layout.mounting; ++i) {
    add(std::string("mounting_r") + kAxes[i] + "_rad", "rad",
        [i](const WristState& s) { return mounting_rpy(s)[i]; });
  }
  for (Index i = 0; i < 3; ++i) {
    add(std::string("bias_") + kAxes[i] + "_n", "N", [i](const WristState& s) { return s.bias[i]; });
  }
  for (Index i = 0; i < 3 && fit.layout.torque; ++i) {
    add(std::string("bias_t") + kAxes[i] + "_nm", "N*m",
        [i](const WristState& s) { return s.bias_torque[i]; });
  }
  return all;
}

std::vector<BesideTool> beside_estimates(const std::vector<WristLog>& logs, const WristFit& fit,
                                         const WristState& point, const Draws& draws) {
  std::vector<BesideTool> all;
  Index first = 0;
  for (const Law& law : fit.state.laws) {
    BesideTool beside{law.effect, law.axis, "", {}};
    VectorXd amplitudes(static_cast<Index>(law.names.size()));
    for (std::size_t k = 0; k < law.names.size(); ++k) {
      const Index place = first + static_cast<Index>(k);
      const double before = law.effect == "time_delay" ? logs.front().delay_s : 0.0;
      beside.parameters.push_back(
          estimate(law.names[k], law.units[k],
                   [=](const WristState& s) { return before + s.amplitudes[place]; }, point, draws));
      amplitudes[static_cast<Index>(k)] = beside.parameters.back().value;
    }
    beside.words = law_words(law, amplitudes);
    all.push_back(beside);
    first += static_cast<Index>(law.names.size());
  }
  return all;
}

}  // namespace dcnn::identification
