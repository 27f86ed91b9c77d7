// SPDX-License-Identifier: Apache-2.0
// What a rigid tool's force is made of, from a pose, low-passed as the force is.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// A row is read as a whole: its numbers lie side by side.
using SignalRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Signals at equal steps of time; a row without enough samples around it is not whole.
struct EvenSignals {
  double begin = 0.0, step = 0.0;  ///< s
  SignalRows values;               ///< (rows, signals)
  std::vector<char> whole;

  /// By a cubic through the four rows around; false outside of them or beside a gap.
  bool at(double time, Eigen::Ref<Eigen::RowVectorXd> out) const;
};

/// Two Gaussians in turn. The first, three times as wide in frequency, is on the samples, so that
/// they can be differentiated; the second, which falls by 3 dB at `hz`, on what is made of them.
class BandFilter {
 public:
  explicit BandFilter(double hz);
  /// Standard deviation of the first Gaussian, s.
  double first() const { return first_; }
  /// Samples that are independent after both, per second.
  double independent() const;

  /// F low-passed.
  EvenSignals force(const std::vector<double>& t, const Eigen::MatrixXd& force) const;
  /// Of a pose x y z, qw qx qy qz: u, R'a, dw/dt, products of w, R'v and R'v/|v|, and 1.
  EvenSignals pose(const std::vector<double>& t, const Eigen::MatrixXd& pose) const;

 private:
  EvenSignals sampled(const std::vector<double>& t, const Eigen::MatrixXd& values) const;
  EvenSignals smoothed(const EvenSignals& from) const;

  double first_ = 0.0, second_ = 0.0;  // s
};

}  // namespace dcnn
