// SPDX-License-Identifier: Apache-2.0
// Discrete Fourier transforms of real signals.
#pragma once

#include <Eigen/Dense>
#include <complex>
#include <memory>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// The least length of at least n that is a product of 2, 3 and 5, for which transforms are fast.
Index fast_length(Index n);

/// The transform of real signals of one length: what depends on the length alone is prepared once.
class Fourier {
 public:
  explicit Fourier(Index n);

  /// X_k = sum_n x_n exp(-2 pi i k n/N), k = 0 … N/2.
  Eigen::VectorXcd operator()(const Eigen::VectorXd& x) const;
  /// The real signal whose transform it is.
  Eigen::VectorXd inverse(const Eigen::VectorXcd& X) const;

 private:
  class Chirp;
  std::vector<std::complex<double>> transformed(const std::vector<std::complex<double>>& x) const;

  Index n_;
  std::vector<std::complex<double>> roots_;  // exp(-2 pi i k/n)
  std::shared_ptr<const Chirp> chirp_;       // where the length has a large prime factor
};

/// The same for one signal.
Eigen::VectorXcd fourier(const Eigen::VectorXd& x);

/// sum_n x_n cos(pi k (n + 1/2)/N), k = 0 … N-1 (the type-II cosine transform, not normalised).
Eigen::VectorXd cosine_transform(const Eigen::VectorXd& x);

}  // namespace dcnn
