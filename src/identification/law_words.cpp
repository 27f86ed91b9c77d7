// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>

#include "identification/laws.h"

namespace dcnn::identification {
namespace {

template <class... Args>
std::string words(const char* format, Args... args) {
  char line[240];
  std::snprintf(line, sizeof line, format, args...);
  return line;
}

/// "along the tool", "along base x", "against turning about the sensor's y axis".
std::string along(const std::string& axis) {
  if (axis == "tool_z") return "along the tool";
  if (axis.starts_with("w_")) return std::string("of the turn about the sensor's ") + axis.back();
  const std::string frame = axis.starts_with("base") ? "base " : "the sensor's ";
  return "along " + frame + axis.back();
}

std::string friction_words(const Law& law, const Eigen::VectorXd& a) {
  std::string text = "friction " + along(law.axis) + ":";
  for (std::size_t k = 0; k < law.names.size(); ++k) {
    const bool dry = law.names[k] == "fc_n";
    text += words("%s %.3g %s %s", k > 0 ? "," : "", a[static_cast<Index>(k)], law.units[k].c_str(),
                  dry ? "dry" : "viscous");
  }
  return text;
}

}  // namespace

std::string law_words(const Law& law, const Eigen::VectorXd& a) {
  if (law.effect == "friction") return friction_words(law, a);
  if (law.effect == "time_delay") {
    return words("the force %s the pose by %.3g ms", a[0] < 0.0 ? "leads" : "lags",
                 1e3 * std::abs(a[0]));
  }
  if (law.effect == "gravity_tilt") {
    return words("the base is not level: turned by %.3g rad about x and %.3g rad about y", a[0],
                 a[1]);
  }
  if (law.effect == "linear_drift") {
    return words("the offset drifts by %.3g, %.3g, %.3g N/s", a[0], a[1], a[2]);
  }
  if (law.effect == "bias") {
    return "the offset in " + law.axis + words(" differs by %.3g, %.3g, %.3g N", a[0], a[1], a[2]);
  }
  if (law.effect == "weightless_mass") {
    return a[0] > 0.0 ? words("an inertia of %.3g kg whose weight is not felt", a[0])
                      : words("of the tool's inertia %.3g kg are not felt", -a[0]);
  }
  if (law.effect == "cable_spring") {
    const auto colon = law.axis.find(':');
    return "a force " + along(law.axis.substr(colon + 1)) + " that follows " +
           law.axis.substr(0, colon) + words(": %.3g N/rad", -a[0]) +
           (a[0] > 0.0 ? ", as of a cable" : "");
  }
  if (law.effect == "gain") {
    return words("the sensor's axes have unequal gains: x over y by %.3g %%, y over z by %.3g %%",
                 100.0 * a[0], 100.0 * a[1]);
  }
  return words("the sensor's axes are not square: xy %.3g %%, xz %.3g %%, yz %.3g %%", 100.0 * a[0],
               100.0 * a[1], 100.0 * a[2]);
}

}  // namespace dcnn::identification
