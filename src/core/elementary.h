// SPDX-License-Identifier: Apache-2.0
// Elementary functions whose values are the same on every processor. The C library chooses among
// variants of its own when a program starts (with and without fused multiply-add), whose last bits
// differ. These are made of additions, multiplications, divisions and square roots, which IEEE 754
// defines to the last bit.
#pragma once

#include <Eigen/Dense>
#include <complex>

namespace dcnn::elementary {

// Errors below 3 units in the last place unless said otherwise; NaN, infinities and domains as in
// <cmath>.
double exp(double x);
double expm1(double x);  ///< exp(x) - 1
double log(double x);
double log1p(double x);  ///< log(1 + x)
/// x^y = exp(y log x) of x >= 0; relative error below 3e-16 (1 + abs(y log x)).
double pow(double x, double y);
double pow(double x, int n);  ///< by repeated products; of any x
double tanh(double x);

/// Of an angle in rad. Beyond 1e8 rad it is first reduced by the double nearest 2 pi, which changes
/// it by less than its own rounding.
double sin(double angle);
double cos(double angle);
double tan(double angle);

double atan2(double y, double x);
double acos(double x);

std::complex<double> polar(double radius, double angle);  ///< radius·exp(i angle)
std::complex<double> exp(std::complex<double> z);

/// Element by element, as expressions.
#define DCNN_ELEMENTWISE(function)                                              \
  template <class Array>                                                        \
  auto function(const Eigen::ArrayBase<Array>& x) {                             \
    return x.derived().unaryExpr([](double value) { return function(value); }); \
  }
DCNN_ELEMENTWISE(exp)
DCNN_ELEMENTWISE(log)
DCNN_ELEMENTWISE(tanh)
DCNN_ELEMENTWISE(sin)
DCNN_ELEMENTWISE(cos)
#undef DCNN_ELEMENTWISE

}  // namespace dcnn::elementary
