// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/passed_base.h"

#include <algorithm>

#include "dcnn/data/filter.h"
#include "physics/effect_law.h"

namespace dcnn {

bool passes_base(const Member& member) {
  return member.kind->stage == Stage::kDynamics && member.amplitudes.size() == 0;
}

Eigen::MatrixXd passed_base(const Setting& setting, const std::vector<Member>& members) {
  const Case& study = setting.study;
  const auto count = static_cast<Index>(study.logs.front().regressors.size());
  if (std::none_of(members.begin(), members.end(), passes_base)) {
    return setting.nuisance.leftCols(count);
  }
  std::vector<Member> passing;
  std::copy_if(members.begin(), members.end(), std::back_inserter(passing), passes_base);
  const std::vector<EffectSpec> effects = specs_of(passing);
  Eigen::MatrixXd columns(setting.whitener.rows(), count);
  for_each_piece(count, [&](Index k) {
    Signals signals;
    for (const Log& log : study.logs) {
      const auto at = static_cast<std::size_t>(k);
      Wrench wrench{Eigen::MatrixXd::Zero(log.motion.samples(), 3), Eigen::MatrixXd(0, 3)};
      wrench.force.col(0) = log.regressors[at];
      wrench.load = wrench.force;
      pass_on(effects, Stage::kResonance, log.motion, study.simulator.model, wrench);
      signals.push_back(low_pass(measured_part(study, wrench), log.motion.segments, log.motion.dt,
                                 study.lowpass_hz));
    }
    columns.col(k) = setting.whitened(signals);
  });
  return columns;
}

double left_beside_base(const Setting& setting, const Chain& chain, Eigen::MatrixXd tangent,
                        Index first_of_base, const Member& lag) {
  std::vector<Member> members = chain.members();
  members.push_back(lag);
  const Eigen::MatrixXd base = passed_base(setting, members);
  tangent.middleCols(first_of_base, base.cols()) = base;
  const Eigen::VectorXd left =
      setting.whitened(setting.measured) - setting.whitened(chain.with(lag));
  return off_basis(left, orthonormal(tangent)).squaredNorm();
}

}  // namespace dcnn
