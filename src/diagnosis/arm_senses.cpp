// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/arm_senses.h"

#include <utility>

namespace dcnn {
namespace {

using Eigen::VectorXd;

/// The regression of a model without the friction of joints in which it would push: what is not
/// possible explains nothing.
ArmRegression of_possible(const ArmSums& sums, ArmModel model, const VectorXd& senses,
                          const VectorXd& variances) {
  ArmRegression any(sums, model);
  any.set_variances(variances);
  const VectorXd power = any.resisted();
  for (Index j = 0; j < power.size(); ++j) {
    const double sense = senses(j) * model.turned(j);
    if (power(j) * sense < 0.0) model.own[static_cast<std::size_t>(j)] = {0};
  }
  ArmRegression possible(sums, std::move(model));
  possible.set_variances(variances);
  return possible;
}

/// The models that a step may lead to: one joint turned, or all, or all joints of one sense, as
/// they mostly are.
std::vector<ArmModel> steps_from(const ArmModel& model, const VectorXd& senses) {
  std::vector<ArmModel> list(static_cast<std::size_t>(senses.size()) + 3, model);
  for (Index j = 0; j < senses.size(); ++j) {
    list[static_cast<std::size_t>(j)].turned(j) = -model.turned(j);
  }
  list[list.size() - 3].turned = -model.turned;
  list[list.size() - 2].turned = senses;
  list[list.size() - 1].turned = -senses;
  return list;
}

}  // namespace

/// The torque of one joint, which others drive as well, may look like a reaction beside its own
/// motion alone. How links are coupled tells joints of one sense from those of the other, friction
/// tells which is which: a step is taken while pieces of time that were left out are predicted
/// better, each time the one that helps most.
ArmModel with_likeliest_senses(const ArmSums& sums, const Eigen::MatrixXd& told,
                               const VectorXd& senses) {
  std::vector<Index> friction;
  for (Index k = 0; k < kOwnFriction; ++k) friction.push_back(k);
  ArmModel model{told, std::vector<std::vector<Index>>(sums.joints(), friction),
                 VectorXd::Ones(senses.size())};
  const Index most_steps = 2 * senses.size();
  for (Index step = 0; step < most_steps; ++step) {
    ArmRegression weights(sums, model);
    weights.reweight();
    const ArmRegression now = of_possible(sums, model, senses, weights.variances());
    double most = 0.0;
    ArmModel best;
    for (ArmModel& next : steps_from(model, senses)) {
      const ArmRegression then = of_possible(sums, next, senses, weights.variances());
      const double support = then.log_support_against(now);
      if (support > most) most = support, best = std::move(next);
    }
    if (most == 0.0) break;
    model = std::move(best);
  }
  return model;
}

}  // namespace dcnn
