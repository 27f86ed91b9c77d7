// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace dcnn {
namespace {

/// Second-order section, direct form II transposed: y = b·x - a·y with a0 = 1.
struct Section {
  double b0, b1, b2, a1, a2;

  /// Starts in the steady state of the first sample, so that a constant passes unchanged.
  void run(Eigen::VectorXd& x) const {
    double s1 = (1.0 - b0) * x[0];
    double s2 = (b2 - a2) * x[0];
    for (double& value : x) {
      const double y = b0 * value + s1;
      s1 = b1 * value - a1 * y + s2;
      s2 = b2 * value - a2 * y;
      value = y;
    }
  }
};

/// Low-pass section of quality Q by the bilinear transform with the cutoff prewarped; gain 1 at
/// rest.
Section make_section(double hz, double dt, double quality) {
  const double k = elementary::tan(std::numbers::pi * hz * dt);
  const double norm = 1.0 / (1.0 + k / quality + k * k);
  const double b0 = k * k * norm;
  return {b0, 2.0 * b0, b0, 2.0 * (k * k - 1.0) * norm, (1.0 - k / quality + k * k) * norm};
}

/// Mirrors the signal through its end points, so that neither value nor slope jumps there.
Eigen::VectorXd odd_padded(const Eigen::Ref<const Eigen::VectorXd>& x, Index pad) {
  const Index n = x.size();
  Eigen::VectorXd padded(n + 2 * pad);
  padded.segment(pad, n) = x;
  for (Index k = 1; k <= pad; ++k) {
    padded[pad - k] = 2.0 * x[0] - x[k];
    padded[pad + n - 1 + k] = 2.0 * x[n - 1] - x[n - 1 - k];
  }
  return padded;
}

}  // namespace

Eigen::MatrixXd low_pass(const Eigen::MatrixXd& signals, const Recording& recording, double hz) {
  if (hz == 0.0 || recording.dt == 0.0) return signals;
  require(2.0 * hz * recording.dt < 1.0, Exit::kData, recording.name, ": a low-pass at ", hz,
          " Hz needs a rate above ", 2.0 * hz, " Hz, this recording has ", 1.0 / recording.dt,
          " Hz; lower lowpass_hz");
  return low_pass(signals, recording.segments, recording.dt, hz);
}

Eigen::MatrixXd low_pass(const Eigen::MatrixXd& signals, const std::vector<Segment>& segments,
                         double dt, double hz) {
  if (hz == 0.0) return signals;
  // Poles of the Butterworth filter of order 4 at pi/8 and 3·pi/8 from the real axis.
  const Section sections[] = {
      make_section(hz, dt, 0.5 / elementary::cos(std::numbers::pi / 8.0)),
      make_section(hz, dt, 0.5 / elementary::cos(3.0 * std::numbers::pi / 8.0))};
  const auto settling = static_cast<Index>(std::ceil(5.0 / (hz * dt)));
  Eigen::MatrixXd filtered(signals.rows(), signals.cols());
  for (const Segment& segment : segments) {
    const Index pad = std::min(segment.size() - 1, settling);
    for (Index column = 0; column < signals.cols(); ++column) {
      Eigen::VectorXd x =
          odd_padded(signals.col(column).segment(segment.begin, segment.size()), pad);
      for (int pass = 0; pass < 2; ++pass) {
        for (const Section& section : sections) section.run(x);
        x.reverseInPlace();
      }
      filtered.col(column).segment(segment.begin, segment.size()) = x.segment(pad, segment.size());
    }
  }
  return filtered;
}

}  // namespace dcnn
