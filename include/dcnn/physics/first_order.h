// SPDX-License-Identifier: Apache-2.0
// Exact response of x' = p·x + u, of which every linear filter is made.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

namespace dcnn {

/// Advances x' = p·x + u over a step of h seconds exactly for an input that runs linearly from u0
/// to u1 (first-order hold; Franklin, Powell and Workman 1998, section 6.3.2). `Scalar` is double
/// or complex.
template <class Scalar>
class FirstOrder {
 public:
  explicit FirstOrder(Scalar pole) : pole_(pole) {}

  Scalar advance(Scalar x, double u0, double u1, double h) {
    const Step& step = step_of(h);
    return step.decay * x + step.from_constant * u0 + step.from_ramp * (u1 - u0);
  }

 private:
  struct Step {
    double h = -1.0;
    Scalar decay{}, from_constant{}, from_ramp{};
  };
  /// Steps of a regular clock differ in their last digits, and those of one whose stamps are
  /// rounded take two or three values.
  const Step& step_of(double h) {
    for (std::size_t k = 0; k < kKept; ++k) {
      const Step& step = steps_[(latest_ + k) % kKept];
      if (std::abs(h - step.h) <= 1e-9 * h) return step;
    }
    latest_ = (latest_ + kKept - 1) % kKept;
    return steps_[latest_] = prepared(h);
  }
  Step prepared(double h) const;

  static constexpr std::size_t kKept = 4;
  Scalar pole_;
  std::array<Step, kKept> steps_{};
  std::size_t latest_ = 0;
};

}  // namespace dcnn
