// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/law_search.h"

#include <numeric>

namespace dcnn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The force on the tool to which a law is added.
MatrixXd load_of(const Simulator& simulator, const std::vector<EffectSpec>& effects,
                 const Log& log) {
  ToolModel model = changed_tool(simulator.model, effects);
  model.bias.setZero();
  model.bias_torque.setZero();
  Wrench wrench = rigid_wrench(model, log.motion);
  if (log.base.force.rows() > 0) wrench.force += log.base.force;
  for (const EffectSpec& effect : effects) {
    if (find_effect(effect.effect)->stage == Stage::kForce) {
      apply_effect(effect, log.motion, model, wrench);
    }
  }
  return wrench.force;
}

/// Forces as the channels that a case measures.
Signals channels_of(const Case& study, const std::vector<MatrixXd>& forces) {
  Signals signals;
  for (const MatrixXd& force : forces) {
    signals.push_back(measured_part(study, {force, MatrixXd::Zero(force.rows(), 3)}));
  }
  return signals;
}

/// Channels as forces.
std::vector<MatrixXd> forces_of(const Case& study, const Signals& signals) {
  std::vector<MatrixXd> forces;
  for (const MatrixXd& signal : signals) {
    forces.emplace_back(MatrixXd::Zero(signal.rows(), 3));
    for (Index j = 0; j < signal.cols(); ++j) {
      const int channel = study.channels[static_cast<std::size_t>(j)];
      if (channel < 3) forces.back().col(channel) = signal.col(j);
    }
  }
  return forces;
}

/// What the effects behind the forces on the tool, up to the sensor's offsets, make of forces.
class Passage {
 public:
  Passage(const Case& study, const std::vector<EffectSpec>& effects)
      : study_(study), model_(changed_tool(study.simulator.model, effects)) {
    for (const EffectSpec& effect : effects) {
      const Stage stage = find_effect(effect.effect)->stage;
      if (stage > Stage::kForce && stage < Stage::kOffset) behind_.push_back(effect);
    }
    model_.bias.setZero();
    model_.bias_torque.setZero();
  }
  Signals operator()(const std::vector<MatrixXd>& forces) const {
    if (behind_.empty()) return channels_of(study_, forces);
    std::vector<MatrixXd> passed;
    for (std::size_t k = 0; k < forces.size(); ++k) {
      Wrench wrench{forces[k], MatrixXd::Zero(forces[k].rows(), 3)};
      pass_on(behind_, Stage::kResonance, study_.logs[k].motion, model_, wrench);
      passed.push_back(std::move(wrench.force));
    }
    return channels_of(study_, passed);
  }

 private:
  const Case& study_;
  ToolModel model_;
  std::vector<EffectSpec> behind_;
};

/// The residual of a fit as a problem at the rate of `study`, whose rows `whitener` gives; both
/// must outlive it. Rows of forces alone: a law is looked for in the force that it makes, and its
/// lever is fitted afterwards.
discovery::Problem problem_of(const Setting& setting, const JointFit& fit, const Case& study,
                              const Whitener& whitener) {
  discovery::Problem problem;
  const auto effects = effects_of(setting.study, fit.members);
  std::vector<Index> sizes;
  for (const Log& log : study.logs) {
    problem.records.push_back({&log.motion, load_of(setting.study.simulator, effects, log)});
    sizes.push_back(log.motion.samples());
  }
  problem.is_spent = [&study] { return laws_are_spent(study); };
  const std::vector<Index> own = rows_of_forces(study, whitener);
  const Index samples = std::accumulate(sizes.begin(), sizes.end(), Index{0});
  problem.whiten = [passage = Passage(study, effects), &whitener, &setting, own,
                    samples](const std::vector<MatrixXd>& forces) {
    setting.study.law_work->add(samples, 0);
    return VectorXd(whitener(passage(forces)).cwiseProduct(setting.mask)(own));
  };
  problem.transposed = [&study, &whitener, &setting, sizes, own](const VectorXd& rows) {
    VectorXd all = VectorXd::Zero(whitener.rows());
    all(own) = rows;
    return forces_of(study, whitener.transposed(all.cwiseProduct(setting.mask), sizes));
  };
  for (const Index i : own) {
    const Whitener::Row& row = whitener.row_info()[static_cast<std::size_t>(i)];
    problem.rows.push_back({row.log, row.channel, row.t});
  }
  problem.known = orthonormal(fit.tangent(own, Eigen::all));
  const VectorXd residual = fit.residual(own);
  problem.residual = residual - problem.known * (problem.known.transpose() * residual);
  problem.residual = problem.residual.cwiseProduct(setting.mask(own));
  return problem;
}

}  // namespace

bool laws_are_spent(const Case& study) {
  constexpr std::uint64_t kMostSamples = 150'000'000;  // of forces: about a minute
  // All axes of a machine together.
  const std::uint64_t parts = study.axis ? study.axis->system.axes.size() : 1;
  return study.law_work->samples() >= kMostSamples / parts;
}

std::vector<discovery::Discovered> laws_in(const Setting& setting, const JointFit& fit) {
  const Index block = setting.whitener.block();
  const Case thin = thinned(setting.study, block);
  const Whitener coarse = setting.whitener.at_stride(block);
  const auto laws = discovery::discover(problem_of(setting, fit, thin, coarse));
  return laws.empty() ? laws : laws_fitted_to(setting, fit, laws);
}

std::vector<discovery::Discovered> laws_fitted_to(const Setting& setting, const JointFit& fit,
                                                  const std::vector<discovery::Discovered>& laws) {
  return discovery::refitted(problem_of(setting, fit, setting.study, setting.whitener), laws);
}

}  // namespace dcnn
