// Exact response of x' = p·x + u, of which every linear filter is made.
#pragma once

#include <cmath>
#include <complex>

namespace dcnn {

/// Advances x' = p·x + u over a step of h seconds exactly for an input that runs linearly from u0
/// to u1 (first-order hold; Franklin, Powell and Workman 1998, section 6.3.2). `Scalar` is double
/// or complex.
template <class Scalar>
class FirstOrder {
 public:
  explicit FirstOrder(Scalar pole) : pole_(pole) {}

  Scalar advance(Scalar x, double u0, double u1, double h) {
    // Steps of a regular clock differ in their last digits.
    if (std::abs(h - h_) > 1e-9 * h) prepare(h);
    return decay_ * x + from_constant_ * u0 + from_ramp_ * (u1 - u0);
  }

 private:
  void prepare(double h);

  Scalar pole_;
  double h_ = -1.0;
  Scalar decay_{}, from_constant_{}, from_ramp_{};
};

}  // namespace dcnn
