// SPDX-License-Identifier: Apache-2.0
// Cases of the axes of other machines: one axis each.
#pragma once

#include <set>
#include <string>

#include "dcnn/physics/axis_machine.h"
#include "diagnosis/chain.h"
#include "diagnosis/load.h"

namespace dcnn {

/// One case per axis of the system description, and what concerns all of them.
struct LoadedAxes {
  std::vector<LoadedCase> cases;
  Json finding;                                     ///< of a whole arm; null: none
  std::optional<AxisMachine> given = std::nullopt;  ///< the simulator, where it is a model.json
};
/// Error(kData) for what cannot be used.
LoadedAxes load_axes(const DiagnosisRequest& request);

/// Whether something was found for the whole arm, and the case without it, with the simulator that
/// was given.
bool is_corrected(const Case& study);
Case as_given(Case study);

/// The logged columns of motion that the case knows: its axis' own, and of an arm all joints'.
std::set<std::string> motion_columns(const AxisPlan& plan);

/// Motion and base simulator of all logs by the case's estimator.
void set_axis_motion(Case& study);

/// Lets the base simulator of all logs have these coefficients (JointFit::base).
void set_base(Case& study, const Eigen::VectorXd& coefficients);
/// The parameters of the base simulator's columns that this makes.
Eigen::VectorXd base_parameters(const Case& study, const Eigen::VectorXd& fitted);

/// measured - predicted, before the low-pass where there is one.
Signals unfiltered_left(const Case& study, const std::vector<Member>& members);

}  // namespace dcnn
