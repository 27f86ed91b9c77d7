// SPDX-License-Identifier: Apache-2.0
#include "core/tails.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace dcnn {
namespace {

constexpr double kNegligible = 1e-17;  // of a sum: what no double shows

/// ln n! - ln(sqrt(2 pi n) (n/e)^n) of n >= 1, by the product below 16 and by its asymptotic series
/// from there on (error below 1e-14).
double stirling_error(double n) {
  if (n < 16.0) {
    double factorial = 1.0;
    for (double k = 2.0; k <= n; ++k) factorial *= k;
    return elementary::log(factorial) - (n + 0.5) * elementary::log(n) + n -
           0.5 * elementary::log(2.0 * std::numbers::pi);
  }
  const double s = 1.0 / (n * n);
  return (1.0 / 12.0 - s * (1.0 / 360.0 - s * (1.0 / 1260.0 - s / 1680.0))) / n;
}

/// x ln(x/m) + m - x of x > 0, half a count's deviance; near x = m, where the quotient's rounding
/// would be all of it, by log1p.
double deviance(double x, double m) {
  const bool near = std::abs(x - m) < 0.1 * m;
  const double logarithm =
      near ? elementary::log1p((x - m) / m) : elementary::log(x) - elementary::log(m);
  return x * logarithm + m - x;
}

double poisson_term(double k, double mean) {
  if (k == 0.0) return elementary::exp(-mean);
  return elementary::exp(-stirling_error(k) - deviance(k, mean)) /
         std::sqrt(2.0 * std::numbers::pi * k);
}

double binomial_term(double k, double n, double p) {
  if (k == 0.0) return elementary::exp(n * elementary::log1p(-p));
  if (k == n) return elementary::exp(n * elementary::log(p));
  const double exponent = stirling_error(n) - stirling_error(k) - stirling_error(n - k) -
                          deviance(k, n * p) - deviance(n - k, n * (1.0 - p));
  return elementary::exp(exponent) * std::sqrt(n / (2.0 * std::numbers::pi * k * (n - k)));
}

/// Sum of falling terms from k on: term(k + step) = ratio(k) term(k), until they are negligible.
template <class Ratio>
double sum_of_terms(double term, double k, double step, const Ratio& ratio) {
  double sum = 0.0;
  for (; term > kNegligible * sum; k += step) {
    sum += term;
    term *= ratio(k);
  }
  return sum;
}

}  // namespace

double poisson_tail(double count, double mean) {
  const double events = std::floor(count);
  if (events <= 0.0) return 1.0;
  if (mean <= 0.0) return 0.0;
  if (events > mean) {
    return sum_of_terms(poisson_term(events, mean), events, 1.0,
                        [&](double k) { return mean / (k + 1.0); });
  }
  const double fewer = sum_of_terms(poisson_term(events - 1.0, mean), events - 1.0, -1.0,
                                    [&](double k) { return k / mean; });
  return std::max(0.0, 1.0 - fewer);
}

double binomial_tail(double count, double trials, double probability) {
  const double k = std::floor(count), n = std::floor(trials), p = probability;
  if (k <= 0.0) return 1.0;
  if (k > n || p <= 0.0) return 0.0;
  if (p >= 1.0) return 1.0;
  const double odds = p / (1.0 - p);
  if (k > n * p) {
    return sum_of_terms(binomial_term(k, n, p), k, 1.0,
                        [&](double j) { return (n - j) / (j + 1.0) * odds; });
  }
  const double fewer = sum_of_terms(binomial_term(k - 1.0, n, p), k - 1.0, -1.0,
                                    [&](double j) { return j / (n - j + 1.0) / odds; });
  return std::max(0.0, 1.0 - fewer);
}

double normal_tail(double z) {
  constexpr double kFar = 2.5;  // from there on Laplace's continued fraction, before it the series
  constexpr int kTerms = 150;   // of the fraction: error below e^-80
  if (z < 0.0) return 1.0 - normal_tail(-z);
  const double density = elementary::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
  if (z < kFar) {  // Marsaglia 2004: z + z^3/3 + z^5/(3 5) + ...
    double term = z, sum = z;
    for (double k = 3.0; term > kNegligible * sum; k += 2.0) sum += term *= z * z / k;
    return 0.5 - density * sum;
  }
  double fraction = z;
  for (int k = kTerms; k > 0; --k) fraction = z + k / fraction;
  return density / fraction;
}

}  // namespace dcnn
