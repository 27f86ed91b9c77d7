// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/loss.h"

#include <cassert>

namespace dcnn {

Tensor half_mean_squared_error(const Tensor& predicted, const Tensor& wanted) {
  assert(predicted.shape() == wanted.shape());
  double sum = 0;
  for (Index i = 0; i < predicted.size(); ++i) {
    const double error =
        static_cast<double>(predicted.data()[i]) - static_cast<double>(wanted.data()[i]);
    sum += error * error;
  }
  const double samples = static_cast<double>(predicted.dim(0));
  Tensor loss({1});
  loss.data()[0] = static_cast<Real>(0.5 * sum / samples);
  return record(loss, {predicted}, [predicted, wanted](const Tensor& out) {
    const Real scale = out.gradient()[0] / static_cast<Real>(predicted.dim(0));
    Real* gradient = predicted.gradient_data();
    for (Index i = 0; i < predicted.size(); ++i) {
      gradient[i] += scale * (predicted.data()[i] - wanted.data()[i]);
    }
  });
}

}  // namespace dcnn
