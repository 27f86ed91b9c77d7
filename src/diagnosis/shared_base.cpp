// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/shared_base.h"

#include <algorithm>
#include <memory>

#include "dcnn/physics/axis_machine.h"
#include "diagnosis/arm_senses.h"
#include "diagnosis/axis_case.h"
#include "diagnosis/evidence/posterior.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/given_arm.h"

namespace dcnn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Lets both cases of a joint have another plan, with these parameters of its base simulator's
/// columns.
void give_plan(LoadedCase& joint, const AxisPlan& plan, const VectorXd& parameters) {
  for (Case* study : {&joint.fit, &joint.holdout}) {
    study->axis = std::make_shared<const AxisPlan>(plan);
    study->base_coefficients = plan.sense * parameters;
    set_axis_motion(*study);
  }
}

std::vector<JointRows> all_rows(const std::vector<LoadedCase>& cases, const VectorXd& bodies) {
  std::vector<JointRows> rows;
  for (const LoadedCase& joint : cases) rows.push_back(rows_of(joint, bodies));
  return rows;
}

void set_sense(LoadedCase& joint, double sense) {
  AxisPlan plan = *joint.fit.axis;
  if (plan.sense == sense) return;
  plan.sense = sense;
  for (Case* study : {&joint.fit, &joint.holdout}) {
    for (Log& log : study->logs) {
      log.measured = -log.measured;
      log.unfiltered = -log.unfiltered;
    }
    study->axis = std::make_shared<const AxisPlan>(plan);
    set_axis_motion(*study);
  }
}

void fit_links(std::vector<LoadedCase>& cases) {
  const std::vector<JointRows> rows = all_rows(cases, VectorXd());
  const ArmSums sums(rows);
  const MatrixXd told = told_parameters(rows);
  VectorXd senses(static_cast<Index>(cases.size()));
  for (std::size_t j = 0; j < cases.size(); ++j) {
    senses(static_cast<Index>(j)) = cases[j].fit.axis->sense;
  }
  ArmModel model = with_likeliest_senses(sums, told, senses);
  // A weight that hardly turns is a constant, too: offsets beside the links would take a part of it
  // from what the links alone predict. One that is there is found as a name.
  for (std::vector<Index>& own : model.own) std::erase(own, kOwnOffset);
  ArmRegression regression(sums, model);
  regression.reweight();
  regression.shrink();
  std::vector<Index> columns;
  for (Index k = 0; k < told.rows(); ++k) {
    if (told.row(k).any()) columns.push_back(k);
  }
  const VectorXd parameters = regression.shared(-1);
  const MatrixXd deviations = regression.deviations();
  for (std::size_t j = 0; j < cases.size(); ++j) {
    const auto joint = static_cast<Index>(j);
    set_sense(cases[j], model.turned(joint) * senses(joint));
    const bool alone = evidence::updated(prior::kName, regression.log_support_alone(j)) > 0.5;
    AxisPlan plan = *cases[j].fit.axis;
    plan.columns = columns;
    plan.base_is_known = true;
    plan.base_deviations = alone ? regression.deviations(j) : deviations;
    give_plan(cases[j], plan, alone ? regression.shared(-1, j) : parameters);
  }
}

/// An arm's sense is one for all its joints: a motor drives all of them, or a sensor bears all.
void vote_on_sense(std::vector<LoadedCase>& cases) {
  double votes = 0.0;
  for (const LoadedCase& joint : cases) votes += joint.fit.axis->sense;
  for (LoadedCase& joint : cases) set_sense(joint, votes < 0.0 ? -1.0 : 1.0);
}

Json correct_given(std::vector<LoadedCase>& cases, const VectorXd& bodies) {
  vote_on_sense(cases);
  const JointChain chain = chain_of(cases.front().fit.axis->system);
  const GivenArm found = what_is_missing(all_rows(cases, bodies), chain, bodies);
  for (LoadedCase& joint : cases) {
    AxisPlan plan = *joint.fit.axis;
    plan.given = bodies;
    plan.columns.clear();
    for (Index k = 0; k < bodies.size(); ++k) plan.columns.push_back(k);
    plan.base_is_known = bodies.size() > 0;
    if (found.missing == GivenArm::Missing::kPayload) plan.payload = found.payload;
    give_plan(joint, plan, found.missing == GivenArm::Missing::kLinks ? found.links : bodies);
  }
  return found.finding;
}

}  // namespace

Json share_base(std::vector<LoadedCase>& cases) {
  const System& system = cases.front().fit.axis->system;
  if (cases.size() < 2 || system.arm.is_null()) return nullptr;
  const auto simulated = [](const Axis& axis) { return !axis.simulated.empty(); };
  const auto based = [](const Axis& axis) { return axis.has_base; };
  const std::vector<Axis>& axes = system.axes;
  if (std::any_of(axes.begin(), axes.end(), based)) return nullptr;
  if (std::all_of(axes.begin(), axes.end(), simulated)) return correct_given(cases, VectorXd());
  if (std::any_of(axes.begin(), axes.end(), simulated)) return nullptr;
  if (const auto bodies = chain_of(system).bodies()) return correct_given(cases, *bodies);
  fit_links(cases);
  return nullptr;
}

}  // namespace dcnn
