// Zero-phase smoothing and differentiation in the frequency domain.
#pragma once

#include "dcnn/data/derivative.h"

namespace dcnn {

/// Value, first and second derivative of x after the zero-phase low-pass 1/(1 + (f/cutoff)^8), which
/// leaves the motion band as it is: what a causal or a local polynomial fit cannot do. The signal is
/// mirrored oddly through its ends over up to 2 s.
struct Smoothed {
  Eigen::VectorXd value, first, second;
};
Smoothed smooth(const Eigen::Ref<const Eigen::VectorXd>& x, double dt, double cutoff_hz);

}  // namespace dcnn
