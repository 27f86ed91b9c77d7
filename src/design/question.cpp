// SPDX-License-Identifier: Apache-2.0
#include "design/question.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "dcnn/core/options.h"

namespace dcnn::design {
namespace {

constexpr std::size_t kMostHypotheses = 6;  // the cost of a design grows with their square
constexpr double kPause = 5.0;              // s between the recordings at hand and the next

/// The same law along the same axis, whatever its numbers.
bool same_place(const EffectSpec& a, const EffectSpec& b) {
  return a.effect == b.effect && a.axis == b.axis;
}

bool holds(const std::vector<EffectSpec>& list, const EffectSpec& effect) {
  return std::any_of(list.begin(), list.end(),
                     [&](const EffectSpec& e) { return same_place(e, effect); });
}

bool same_effects(const Hypothesis& a, const Hypothesis& b) {
  return a.effects.size() == b.effects.size() &&
         std::all_of(a.effects.begin(), a.effects.end(),
                     [&](const EffectSpec& e) { return holds(b.effects, e); });
}

/// What acts in one recording, or for some time that is over, is absent from the next; what follows
/// a temperature, or another logged signal, no motion shows.
void leave_past(std::vector<EffectSpec>& effects) {
  std::erase_if(effects, [](const EffectSpec& e) {
    const EffectKind* kind = find_effect(e.effect);
    return !e.recording.empty() || e.parameters.contains("t_ref_degc") ||
           e.parameters.contains("driven_by") ||
           (e.interval_s && kind && kind->interval != IntervalRule::kOnset);
  });
}

/// Masses of the named structures from their odds, beside the unknown's.
void set_masses(const std::vector<double>& log_odds, Question& question) {
  constexpr double kFarthest = 50.0;  // nats
  double sum = 0.0;
  for (std::size_t k = 0; k < log_odds.size(); ++k) {
    question.hypotheses[k].mass = elementary::exp(std::clamp(log_odds[k], -kFarthest, kFarthest));
    sum += question.hypotheses[k].mass;
  }
  for (Hypothesis& one : question.hypotheses) one.mass *= (1.0 - question.unknown) / sum;
}

int channel_of(const std::string& target, const std::string& where) {
  static const std::vector<std::string> kNames{"fx", "fy", "fz", "tx", "ty", "tz"};
  const auto at = std::find(kNames.begin(), kNames.end(), target);
  require(at != kNames.end(), Exit::kData, where, ": is about '", target,
          "'; a motion is designed for the forces and torques of a tool on a wrist");
  return static_cast<int>(at - kNames.begin());
}

}  // namespace

std::string Question::chosen() const {
  std::string names;
  for (const EffectSpec& e : hypotheses.front().effects)
    names += (names.empty() ? "" : " + ") + e.effect;
  return names.empty() ? "nothing" : names;
}

std::string Question::name_of(std::size_t one, std::size_t other) const {
  std::string names;
  for (const EffectSpec& e : hypotheses[one].effects) {
    if (holds(hypotheses[other].effects, e)) continue;
    const auto same_law = [&](const EffectSpec& o) { return o.effect == e.effect; };
    const auto& others = hypotheses[other].effects;
    const bool by_axis = std::any_of(others.begin(), others.end(), same_law);
    names += (names.empty() ? "" : " + ") + e.effect + (by_axis ? " " + e.axis : "");
  }
  return names.empty() ? "nothing" : names;
}

Question question_of(const Json& report, const Json& model, const std::string& where) {
  for (const char* key : {"targets", "fit", "rivals"}) {
    require(report.contains(key), Exit::kData, where, ": has no '", key,
            "'; make it with this version's dcnn-diagnose");
  }
  Question question;
  for (const Json& target : report["targets"])
    question.channels.push_back(channel_of(target, where));
  const Simulator simulator = parse_simulator(model, where, Exit::kData);
  question.tool = simulator.model;
  question.sample_rate_hz = simulator.model.sample_rate_hz;
  question.noise = report["fit"]["noise_floor"].get<std::vector<double>>();
  const bool noisy =
      std::all_of(question.noise.begin(), question.noise.end(), [](double s) { return s > 0.0; });
  require(noisy && question.noise.size() == question.channels.size(), Exit::kData, where,
          ": has no noise floor for each target");
  if (const Json* posterior = report.find("posterior")) {
    question.unknown =
        posterior->value("unknown", 0.0) + posterior->value("named_and_unknown", 0.0);
  }
  if (report.contains("clock_end_s") && report["clock_end_s"].is_number()) {
    question.start_s = report["clock_end_s"].get<double>() + kPause;
  }
  question.hypotheses.push_back({simulator.effects});
  std::vector<double> log_odds{0.0};
  std::vector<EffectSpec> laws;  // discovered ones act beside every rival
  for (const EffectSpec& e : simulator.effects) {
    if (!e.law.is_null()) laws.push_back(e);
  }
  for (const Json& rival : report["rivals"]) {
    Hypothesis one{parse_effects(rival.at("effects"), where, Exit::kData), 0.0,
                   rival.value("chi2_above", 0.0), rival.value("more_numbers", 0)};
    for (const EffectSpec& law : laws) {
      if (!holds(one.effects, law)) one.effects.push_back(law);
    }
    const auto known = [&](const Hypothesis& other) { return same_effects(one, other); };
    auto& all = question.hypotheses;
    if (all.size() == kMostHypotheses || std::any_of(all.begin(), all.end(), known)) continue;
    all.push_back(one);
    log_odds.push_back(rival.value("log_odds", 0.0));
  }
  for (Hypothesis& one : question.hypotheses) leave_past(one.effects);
  set_masses(log_odds, question);
  std::stable_sort(question.hypotheses.begin() + 1, question.hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.mass > b.mass; });
  return question;
}

}  // namespace dcnn::design
