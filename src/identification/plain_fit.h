// SPDX-License-Identifier: Apache-2.0
// Where the residual is no stationary noise.
#pragma once

#include "identification/wrist_fit.h"

namespace dcnn::identification {

/// Whether a fit under coloured noise, with what was found beside the tool, leaves more than least
/// squares of the tool alone does, beyond what `plain`'s effective rows and the number of its
/// parameters make of chance (one in a thousand). Then the residual is no noise: a filter of the
/// sensor, say, errs in every turn alike. An autoregression takes it for slow noise, gives nearly
/// all weight to the changes, where the model is wrong, and none to the poses held, where it is
/// right (the specification test of Hausman 1978).
bool leaves_more(const WristFit& coloured, const WristFit& plain);

/// Whether what is left of each channel (root mean squares) is more than before, in the mean of the
/// squared ratios. Channels count by what they leave: a law that lets one count for nearly all, on
/// which the tool is then fitted, leaves more of the others than it takes off that.
bool leaves_more_in_all(const Eigen::VectorXd& left, const Eigen::VectorXd& before);

/// What is measured, before a lag is taken off it.
class Advances {
 public:
  explicit Advances(const std::vector<WristLog>& logs);
  void restore(std::vector<WristLog>& logs) const;

 private:
  std::vector<Eigen::MatrixXd> measured_;
  std::vector<double> delay_s_;
};

}  // namespace dcnn::identification
