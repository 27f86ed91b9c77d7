// SPDX-License-Identifier: Apache-2.0
// Forces of some milliseconds in a channel: how large they are about each sample, and how rare.
#pragma once

#include <Eigen/Dense>
#include <map>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// What finds a force that lasts 2 wide + 1 samples, whatever else goes through the samples around
/// it as a parabola does, such as a tremor that the model has not quite: the least-squares weights
/// of that force's mean.
class Template {
 public:
  explicit Template(Index wide);
  Index far() const { return far_; }
  const Eigen::VectorXd& weights() const { return weights_; }
  /// Deviation of the mean in white noise of deviation 1.
  double deviation() const { return weights_.norm(); }

 private:
  Index far_;
  Eigen::VectorXd weights_;
};

/// The force about each sample of a channel, in deviations of its noise.
struct Forces {
  Eigen::VectorXd values;
  /// Normal scores (van der Waerden) of the values, with their signs: of deviation 1 whatever the
  /// tails of the noise.
  Eigen::VectorXd scores;
  Index far;  ///< there is none within so many samples of an end
  bool has(Index at) const { return at >= far && at + far < values.size(); }
};

/// A channel of a recording in deviations of its noise.
class Channel {
 public:
  Channel(const Eigen::VectorXd& r, const Eigen::VectorXd& level)
      : level_(level), r_(r.cwiseQuotient(level)) {}
  double level(Index i) const { return level_(i); }
  const Forces& about(const Template& shape) const;

 private:
  Eigen::VectorXd level_, r_;
  mutable std::map<Index, Forces> forces_;  // by the template's length
};

}  // namespace dcnn
