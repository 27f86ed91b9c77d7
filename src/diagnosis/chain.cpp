// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/chain.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "core/elementary.h"
#include "dcnn/data/filter.h"

namespace dcnn {

namespace {

/// E[q round((F + e)/q)] for Gaussian e: F + q/pi sum_k (-1)^k/k sin(2 pi k F/q) exp(-2 (pi k
/// s/q)^2) (the Fourier series of the sawtooth, damped by the noise).
void round_mean(const Case& study, Eigen::MatrixXd& mean) {
  constexpr double kPi = std::numbers::pi;
  const double q = study.rounding_step;
  std::vector<double> sizes;
  for (int k = 1; k <= 6; ++k) {
    const double a = kPi * k * study.rounding_noise / q;
    const double size = q / (kPi * k) * elementary::exp(-2.0 * a * a);
    if (size < 1e-4 * q) break;
    sizes.push_back(k % 2 ? -size : size);
  }
  if (sizes.empty()) return;  // the noise hides the steps
  for (Index j = 0; j < mean.cols(); ++j) {
    if (!study.is_rounded(j)) continue;
    const Eigen::ArrayXd angle = 2.0 * kPi / q * mean.col(j).array(),
                         twice = 2.0 * elementary::cos(angle);
    Eigen::ArrayXd sine = elementary::sin(angle), before = Eigen::ArrayXd::Zero(angle.size());
    for (const double size : sizes) {
      mean.col(j).array() += size * sine;
      before = twice * sine - before;  // sin((k + 1) x) = 2 cos(x) sin(k x) - sin((k - 1) x)
      before.swap(sine);
    }
  }
}

/// -s dF/dt of delays and lags in place of what they do, before the sensor's offsets.
void linear_lags(const std::vector<EffectSpec>& effects, const Motion& motion,
                 const ToolModel& model, Wrench& wrench) {
  std::vector<EffectSpec> early, late;
  double seconds = 0.0;
  for (const EffectSpec& effect : effects) {
    const EffectKind& kind = *find_effect(effect.effect);
    if (kind.lateness) {
      seconds += effect.parameters.value(kind.lateness, 0.0);
    } else {
      (kind.stage <= Stage::kDynamics ? early : late).push_back(effect);
    }
  }
  ToolModel no_bias = model;
  no_bias.bias.setZero();
  no_bias.bias_torque.setZero();
  pass_on(early, Stage::kResonance, motion, no_bias, wrench);
  for (Eigen::MatrixXd* part : {&wrench.force, &wrench.torque}) {
    const Eigen::MatrixXd f = *part;
    for (const Segment& s : motion.segments) {
      for (Index i = s.begin + 1; i + 1 < s.end && f.rows() > 0; ++i) {
        part->row(i) -= seconds / (2.0 * motion.dt) * (f.row(i + 1) - f.row(i - 1));
      }
    }
  }
  pass_on(late, Stage::kOffset, motion, model, wrench);
}

/// Adds a part, or takes it off.
void add(const Wrench& part, double sign, Wrench& wrench) {
  if (part.force.rows() > 0) wrench.force += sign * part.force;
  if (part.torque.rows() > 0) wrench.torque += sign * part.torque;
}

}  // namespace

std::vector<EffectSpec> effects_of(const Case& study, const std::vector<Member>& members) {
  std::vector<EffectSpec> effects = specs_of(members);
  const auto& given = study.simulator.effects;
  effects.insert(effects.end(), given.begin(), given.end());
  return effects;
}

Chain::Chain(const Case& study, std::vector<Member> members)
    : study_(study), members_(std::move(members)), specs_(effects_of(study, members_)) {
  for (const Log& log : study.logs) {
    stages_.push_back(prepare(log, specs_));
    prediction_.push_back(finish(log, stages_.back(), stages_.back().forced, specs_));
  }
}

/// Rigid part and forces on the tool.
Chain::Stages Chain::prepare(const Log& log, const std::vector<EffectSpec>& effects) const {
  Stages stages{changed_tool(study_.simulator.model, effects), {}, {}, {}, {}};
  ToolModel without_bias = stages.model;
  without_bias.bias.setZero();
  without_bias.bias_torque.setZero();
  stages.forced = rigid_wrench(without_bias, log.motion);
  if (log.base.force.rows() > 0) stages.forced.force += log.base.force;
  if (log.base.torque.rows() > 0) stages.forced.torque += log.base.torque;
  stages.load = stages.forced.force;
  if (log.motion.of_axis) stages.carried.setZero(stages.load.rows(), 3);
  stages.pushes.resize(effects.size());
  for (std::size_t k = 0; k < effects.size() && log.motion.of_axis; ++k) {
    if (!find_effect(effects[k].effect)->is_carried) continue;
    stages.pushes[k] = push_of(effects[k], log, stages);
    stages.carried += stages.pushes[k].force;
  }
  for (std::size_t k = 0; k < effects.size(); ++k) {
    Wrench& push = stages.pushes[k];
    if (push.force.rows() == 0) push = push_of(effects[k], log, stages);
    add(push, 1.0, stages.forced);
  }
  return stages;
}

Eigen::MatrixXd Chain::finish(const Log& log, const Stages& stages, Wrench wrench,
                              const std::vector<EffectSpec>& effects) const {
  study_.work->add(log.motion.samples(), effects.size());
  if (log.motion.of_axis) wrench.load = stages.load;  // of which a machine's scale is off
  if (study_.without.exact_operators) {
    linear_lags(effects, log.motion, stages.model, wrench);
  } else {
    pass_on(effects, Stage::kResonance, log.motion, stages.model, wrench);
  }
  Eigen::MatrixXd mean = measured_part(study_, wrench);
  if (study_.lowpass_hz > 0.0) {
    mean = low_pass(mean, log.motion.segments, log.motion.dt, study_.lowpass_hz);
  }
  if (study_.rounding_step > 0.0) round_mean(study_, mean);
  return mean;
}

Wrench Chain::push_of(const EffectSpec& effect, const Log& log, const Stages& stages) const {
  if (find_effect(effect.effect)->stage != Stage::kForce) return {};
  const Wrench& like = stages.forced;
  Wrench push{Eigen::MatrixXd::Zero(like.force.rows(), like.force.cols()),
              Eigen::MatrixXd::Zero(like.torque.rows(), like.torque.cols())};
  if (find_effect(effect.effect)->of_load) push.load = stages.load, push.carried = stages.carried;
  if (effect.law.is_null()) {
    apply_effect(effect, log.motion, stages.model, push);
  } else {  // may depend on the force that it is added to
    push = stages.forced;
    apply_effect(effect, log.motion, stages.model, push);
    add(stages.forced, -1.0, push);
  }
  return push;
}

Signals Chain::with(const Member& effect, std::optional<std::size_t> instead_of) const {
  const EffectSpec spec = spec_of(effect);
  std::vector<EffectSpec> effects = specs_;
  if (instead_of) {
    effects[*instead_of] = spec;
  } else {
    effects.push_back(spec);
  }
  const bool loads =  // what another effect of the chain depends on
      effect.kind->is_carried && std::any_of(specs_.begin(), specs_.end(), [](const auto& other) {
        return find_effect(other.effect)->of_load;
      });
  Signals result;
  for (std::size_t k = 0; k < study_.logs.size(); ++k) {
    const Log& log = study_.logs[k];
    if (effect.kind->stage == Stage::kTool || (loads && log.motion.of_axis)) {
      const Stages stages = prepare(log, effects);
      result.push_back(finish(log, stages, stages.forced, effects));
      continue;
    }
    Wrench wrench = stages_[k].forced;
    if (effect.kind->stage == Stage::kForce) {
      if (instead_of) add(stages_[k].pushes[*instead_of], -1.0, wrench);
      if (effect.kind->of_load) {
        wrench.load = stages_[k].load;
        wrench.carried = stages_[k].carried;
      }
      apply_effect(spec, log.motion, stages_[k].model, wrench);
    }
    result.push_back(finish(log, stages_[k], std::move(wrench), effects));
  }
  return result;
}

Signals predict(const Case& study, const std::vector<Member>& members) {
  return Chain(study, members).prediction();
}

}  // namespace dcnn
