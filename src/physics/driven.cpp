// SPDX-License-Identifier: Apache-2.0
#include "physics/driven.h"

#include <algorithm>

#include "physics/delay.h"
#include "physics/effect_law.h"

namespace dcnn {

namespace {

constexpr double kLongestLag = 60.0;  // s

}  // namespace

std::optional<Drive> read_drive(const EffectKind& kind, Options& parameters) {
  if (!parameters.has("driven_by")) return std::nullopt;
  if (kind.strength == nullptr) {
    parameters.reject("driven_by", "is for laws of one strength; ", kind.name, " is none");
  }
  Drive drive;
  drive.signal = parameters.get<std::string>("driven_by");
  if (drive.signal.empty()) parameters.reject("driven_by", "must name a column of the recordings");
  drive.slope = parameter(parameters, "slope");
  drive.lag = parameters.number("lag_s", 0.0, -kLongestLag, kLongestLag);
  return drive;
}

void apply_driven(const Drive& drive, const EffectSpec& effect, const Motion& motion,
                  const ToolModel& model, Wrench& wrench) {
  const EffectKind& kind = *find_effect(effect.effect);
  const auto signal =
      std::find_if(motion.signals.begin(), motion.signals.end(),
                   [&](const LoggedSignal& logged) { return logged.name == drive.signal; });
  require(signal != motion.signals.end(), Exit::kData, motion.recording, ": column '", drive.signal,
          "', which ", kind.name, " follows, is missing; log it");
  Eigen::MatrixXd strength = signal->values;
  if (!motion.is_static()) delay(strength, motion, drive.lag);
  strength = effect.parameters.at(kind.strength).get<double>() + drive.slope * strength.array();
  Json unit = effect.parameters;
  unit[kind.strength] = 1.0;
  Options parameters(unit, effect.effect, Exit::kData);
  Wrench alone{Eigen::MatrixXd::Zero(wrench.force.rows(), wrench.force.cols()),
               Eigen::MatrixXd::Zero(wrench.torque.rows(), wrench.torque.cols()), wrench.load,
               wrench.carried};
  kind.apply(alone, motion, effect, model, parameters);
  wrench.force += strength.col(0).asDiagonal() * alone.force;
  if (alone.torque.rows() > 0) wrench.torque += strength.col(0).asDiagonal() * alone.torque;
}

void read_signals(const Recording& recording, const std::vector<std::string>& names,
                  Motion& motion) {
  for (const std::string& name : names) {
    if (recording.has(name)) motion.signals.push_back({name, recording.column(name)});
  }
}

std::vector<std::string> signals_of(const std::vector<EffectSpec>& effects) {
  std::vector<std::string> names;
  for (const EffectSpec& effect : effects) {
    const auto driver = effect.parameters.find("driven_by");
    if (driver) names.push_back(driver->get<std::string>());
    const auto signals =
        effect.law.is_object() ? effect.law.value("signals", Json::array()) : Json::array();
    for (const Json& name : signals) {
      if (name.is_string()) names.push_back(name.get<std::string>());
    }
  }
  return names;
}

}  // namespace dcnn
