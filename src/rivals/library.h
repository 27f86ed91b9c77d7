// SPDX-License-Identifier: Apache-2.0
// The catalogue's laws as columns.
#pragma once

#include <string>

#include "dcnn/physics/simulator.h"
#include "dcnn/rivals/selectors.h"

namespace dcnn::rivals {

/// One law on one axis with its shapes held; the force is linear in its amplitudes.
struct Law {
  std::string effect, axis;
  const EffectFit* fit = nullptr;
  Eigen::VectorXd shapes;
};
std::vector<Law> library(bool thermometer);
/// Columns of each law, one after the other.
std::vector<Group> groups_of(const std::vector<Law>& laws);

/// dF/d(amplitude) for all laws, (3 T, P): fx, then fy, then fz of all samples.
Eigen::MatrixXd columns_of(const std::vector<Law>& laws, const ToolModel& tool,
                           const Motion& motion);

}  // namespace dcnn::rivals
