// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/first_order.h"

#include "core/elementary.h"

namespace dcnn {

template <class Scalar>
typename FirstOrder<Scalar>::Step FirstOrder<Scalar>::prepared(double h) const {
  const Scalar z = pole_ * h;
  const Scalar decay = elementary::exp(z);
  if (std::norm(z) < 1e-6) {  // series: the closed forms cancel
    return {h, decay, h * (1.0 + z / 2.0 + z * z / 6.0 + z * z * z / 24.0),
            h * (0.5 + z / 6.0 + z * z / 24.0 + z * z * z / 120.0)};
  }
  return {h, decay, h * (decay - 1.0) / z, h * (decay - 1.0 - z) / (z * z)};
}

template class FirstOrder<double>;
template class FirstOrder<std::complex<double>>;

}  // namespace dcnn
