// SPDX-License-Identifier: Apache-2.0
#include "core/elementary.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace dcnn::elementary {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

// ln 2 and pi/2 in parts whose products with the whole numbers below are exact (Cody and Waite
// 1980).
constexpr double kLn2High = 0x1.62e42fefp-1, kLn2Low = 0x1.473de6af278edp-34;
constexpr double kQuarterHigh = 0x1.921fb54p+0, kQuarterMiddle = 0x1.10b461p-30,
                 kQuarterLow = 0x1.a62633145c06ep-58;
constexpr double kHalfPi = 0x1.921fb54442d18p+0, kHalfPiRest = 0x1.1a62633145c07p-54;

/// c_0 + c_1 z + … by two chains in z^2, half as deep as Horner's one.
template <std::size_t N>
double polynomial(const std::array<double, N>& c, double z) {
  const double square = z * z;
  double even = 0.0, odd = 0.0;
  for (std::size_t k = N; k-- > 0;) {
    double& chain = k % 2 ? odd : even;
    chain = chain * square + c[k];
  }
  return even + z * odd;
}

/// 1/n! for n = first, first + 2, … with alternating signs: of the series of sine and cosine.
template <std::size_t N>
constexpr std::array<double, N> alternating_factorials(int first) {
  std::array<double, N> c{};
  double factorial = 1.0;  // exact below 2^53, and correct to its last bit above
  for (int n = 2; n <= first; ++n) factorial *= n;
  for (std::size_t k = 0; k < N; ++k) {
    c[k] = (k % 2 ? -1.0 : 1.0) / factorial;
    const int n = first + 2 * static_cast<int>(k);
    factorial *= (n + 1) * (n + 2);
  }
  return c;
}

/// scale/(2k + 3), with alternating signs where asked: of the series of atanh and atan.
template <std::size_t N>
constexpr std::array<double, N> odd_reciprocals(double scale, bool alternating) {
  std::array<double, N> c{};
  for (std::size_t k = 0; k < N; ++k) {
    c[k] = (alternating && k % 2 == 0 ? -scale : scale) / (2.0 * static_cast<double>(k) + 3.0);
  }
  return c;
}

/// 1/2!, 1/3!, …: of the series of exp.
template <std::size_t N>
constexpr std::array<double, N> factorials() {
  std::array<double, N> c{};
  double factorial = 2.0;
  for (std::size_t k = 0; k < N; ++k) {
    c[k] = 1.0 / factorial;
    factorial *= static_cast<double>(k) + 3.0;
  }
  return c;
}

/// The whole number nearest to x, abs(x) < 2^51.
double nearest(double x) {
  constexpr double kShift = 0x1.8p52;
  return (x + kShift) - kShift;
}

double power_of_two(int k) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52);
}

/// x = k ln 2 + r with abs(r) <= ln(2)/2, and exp(r) - 1.
struct Exponential {
  int k;
  double minus_one;
};
Exponential exponential(double x) {
  // The next term, r^14/14!, is below 5e-18.
  static constexpr auto kSeries = factorials<12>();
  const double k = nearest(x * std::numbers::log2e);
  const double high = x - k * kLn2High, low = k * kLn2Low;
  const double r = high - low, rest = (high - r) - low;
  return {static_cast<int>(k), r + (r * r * polynomial(kSeries, r) + rest)};
}

/// angle = quarter·pi/2 + high + low, abs(high) <= pi/4, quarter modulo 4.
struct Reduced {
  int quarter;
  double high, low;
};
Reduced reduced(double angle) {
  constexpr double kLargest = 1e8;  // quarters below 2^26: their products with 27 bits are exact
  if (!std::isfinite(angle)) return {0, kNotANumber, kNotANumber};
  if (std::abs(angle) > kLargest) angle = std::fmod(angle, 2.0 * std::numbers::pi);
  const double n = nearest(angle * (1.0 / kHalfPi));
  const double a = angle - n * kQuarterHigh, b = n * kQuarterMiddle;
  const double sum = a - b, part = a - sum;
  const double low = ((a - (sum + part)) + (part - b)) - n * kQuarterLow;
  const double high = sum + low;
  return {static_cast<int>(static_cast<std::int64_t>(n) & 3), high, (sum - high) + low};
}

double sine(const Reduced& r) {
  static constexpr auto kSeries = alternating_factorials<8>(3);  // 1/3!, -1/5!, …
  const double z = r.high * r.high;
  return r.high + (r.low * (1.0 - 0.5 * z) - r.high * z * polynomial(kSeries, z));
}

double cosine(const Reduced& r) {
  static constexpr auto kSeries = alternating_factorials<7>(4);  // 1/4!, -1/6!, …
  const double z = r.high * r.high, half = 0.5 * z, near = 1.0 - half;
  return near + (((1.0 - near) - half) + (z * z * polynomial(kSeries, z) - r.high * r.low));
}

double sine_of(const Reduced& r, int quarter) {
  const double value = quarter & 1 ? cosine(r) : sine(r);
  return quarter & 2 ? -value : value;
}

/// atan of t in [0, 1].
double arc(double t) {
  constexpr double kEighth = 0.41421356237309503;  // tan(pi/8)
  // With abs(u) <= tan(pi/8) the next term of the series is below 1e-18.
  static constexpr auto kSeries = odd_reciprocals<22>(1.0, true);
  const bool high = t > kEighth;
  const double u = high ? (t - 1.0) / (t + 1.0) : t, z = u * u;
  const double tail = u * z * polynomial(kSeries, z);
  return high ? 0.5 * kHalfPi + (u + (tail + 0.5 * kHalfPiRest)) : u + tail;
}

}  // namespace

double exp(double x) {
  if (std::isnan(x)) return x;
  if (x > 709.79) return kInfinite;
  if (x < -745.2) return 0.0;
  const auto [k, minus_one] = exponential(x);
  return (1.0 + minus_one) * power_of_two(k / 2) * power_of_two(k - k / 2);
}

double expm1(double x) {
  if (std::isnan(x)) return x;
  if (x > 40.0) return exp(x);
  if (x < -40.0) return -1.0;
  const auto [k, minus_one] = exponential(x);
  const double scale = power_of_two(k);
  return k == 0 ? minus_one : (scale - 1.0) + scale * minus_one;
}

double log(double x) {
  if (!(x > 0.0)) return x == 0.0 ? -kInfinite : kNotANumber;
  if (x == kInfinite) return x;
  int k = 0;
  double m = std::frexp(x, &k);
  if (m < std::numbers::sqrt2 / 2.0) {
    m *= 2.0;
    --k;
  }
  // log(1+f) = f - f^2/2 + s (f^2/2 + R), s = f/(2+f), R = 2/3 s^2 + 2/5 s^4 + …
  static constexpr auto kSeries = odd_reciprocals<11>(2.0, false);
  const double f = m - 1.0, s = f / (2.0 + f), z = s * s, half = 0.5 * f * f;
  const double correction = s * (half + z * polynomial(kSeries, z));
  return k * kLn2High - ((half - (correction + k * kLn2Low)) - f);
}

double log1p(double x) {
  const double u = 1.0 + x;
  if (u == 1.0 || !(u > 0.0) || u == kInfinite) return u == 1.0 ? x : log(u);
  return log(u) + (x - (u - 1.0)) / u;
}

double pow(double x, double y) { return y == 0.0 ? 1.0 : exp(y * log(x)); }

double pow(double x, int n) {
  double power = 1.0;
  for (unsigned left = static_cast<unsigned>(std::abs(n)); left > 0; left /= 2, x *= x) {
    if (left % 2) power *= x;
  }
  return n < 0 ? 1.0 / power : power;
}

double tanh(double x) {
  const double a = std::abs(x);
  if (a > 22.0) return std::copysign(1.0, x);
  const double e = expm1(2.0 * a);
  return std::copysign(e / (e + 2.0), x);
}

double sin(double angle) {
  const Reduced r = reduced(angle);
  return sine_of(r, r.quarter);
}

double cos(double angle) {
  const Reduced r = reduced(angle);
  return sine_of(r, r.quarter + 1);
}

double tan(double angle) {
  const Reduced r = reduced(angle);
  return sine_of(r, r.quarter) / sine_of(r, r.quarter + 1);
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return kNotANumber;
  const double a = std::abs(x), b = std::abs(y);
  const double least = std::min(a, b), most = std::max(a, b);
  double angle = most == 0.0 ? 0.0 : least == most ? 0.5 * kHalfPi : arc(least / most);
  if (b > a) angle = kHalfPi - (angle - kHalfPiRest);
  if (std::signbit(x)) angle = 2.0 * kHalfPi - (angle - 2.0 * kHalfPiRest);
  return std::copysign(angle, y);
}

double acos(double x) { return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x); }

std::complex<double> polar(double radius, double angle) {
  const Reduced r = reduced(angle);
  return {radius * sine_of(r, r.quarter + 1), radius * sine_of(r, r.quarter)};
}

std::complex<double> exp(std::complex<double> z) { return polar(exp(z.real()), z.imag()); }

}  // namespace dcnn::elementary
