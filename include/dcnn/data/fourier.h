// Discrete Fourier transforms of real signals.
#pragma once

#include <Eigen/Dense>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// The least length of at least n that is a product of 2, 3 and 5, for which transforms are fast.
Index fast_length(Index n);

/// X_k = sum_n x_n exp(-2 pi i k n/N), k = 0 … N/2.
Eigen::VectorXcd fourier(const Eigen::VectorXd& x);
/// The real signal of length n whose fourier() is `half`.
Eigen::VectorXd inverse_fourier(const Eigen::VectorXcd& half, Index n);

}  // namespace dcnn
