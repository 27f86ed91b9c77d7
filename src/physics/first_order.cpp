#include "dcnn/physics/first_order.h"

#include "core/elementary.h"

namespace dcnn {

template <class Scalar>
void FirstOrder<Scalar>::prepare(double h) {
  const Scalar z = pole_ * h;
  h_ = h;
  decay_ = elementary::exp(z);
  if (std::norm(z) < 1e-6) {  // series: the closed forms cancel
    from_constant_ = h * (1.0 + z / 2.0 + z * z / 6.0 + z * z * z / 24.0);
    from_ramp_ = h * (0.5 + z / 6.0 + z * z / 24.0 + z * z * z / 120.0);
  } else {
    from_constant_ = h * (decay_ - 1.0) / z;
    from_ramp_ = h * (decay_ - 1.0 - z) / (z * z);
  }
}

template void FirstOrder<double>::prepare(double);
template void FirstOrder<std::complex<double>>::prepare(double);

}  // namespace dcnn
