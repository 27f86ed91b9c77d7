// SPDX-License-Identifier: Apache-2.0
#include "data/spectral.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/elementary.h"
#include "data/reflected.h"
#include "dcnn/data/fourier.h"

namespace dcnn {
namespace {

constexpr double kFlankSamples = 50.0;  // at least, of the taper at an end

/// Means of `power` over 2 half + 1 bins, fewer at the ends.
Eigen::VectorXd running_mean(const Eigen::VectorXd& power, Index half) {
  Eigen::VectorXd sum(power.size() + 1), mean(power.size());
  sum(0) = 0.0;
  for (Index k = 0; k < power.size(); ++k) sum(k + 1) = sum(k) + power(k);
  for (Index k = 0; k < power.size(); ++k) {
    const Index first = std::max<Index>(0, k - half), end = std::min(power.size(), k + half + 1);
    mean(k) = (sum(end) - sum(first)) / static_cast<double>(end - first);
  }
  return mean;
}

/// The gain of the fixed edge.
double edge(double hz, double cutoff_hz) {
  const double ratio = hz / cutoff_hz, square = ratio * ratio, fourth = square * square;
  return 1.0 / (1.0 + fourth * fourth);
}

/// What a signal holds above its slow motion, tapered at its ends by the fourth power of a sine: a
/// kink there, or where a reflection ends, would stand over the noise of a pose at all frequencies.
struct Rest {
  Eigen::VectorXcd spectrum;
  Eigen::VectorXd share;  ///< in each bin, of the signal's power
  double fourth = 0.0;    ///< sum of the weights' fourth powers over the square of that of squares
};

/// Of `length` samples whose transform is `above`, of which n after the first `pad` are the signal.
Rest rest_of(Eigen::VectorXcd above, Index length, Index pad, Index n, double dt, double slow_hz,
             const Fourier& transform) {
  const Index bins = above.size();
  Rest rest;
  rest.share.resize(bins);
  for (Index k = 0; k < bins; ++k) {
    const double hz = static_cast<double>(k) / (static_cast<double>(length) * dt);
    const double part = 1.0 - edge(hz, slow_hz);
    above(k) *= part;
    rest.share(k) = part * part;
  }
  Eigen::VectorXd values = transform.inverse(above);
  values.head(pad).setZero();
  values.tail(length - pad - n).setZero();
  const double seconds = std::max(kFlankSeconds, kFlankSamples * dt);
  const double flank = std::clamp(seconds / dt, 1.0, static_cast<double>(n) / 4.0 + 1.0);
  double squares = 0.0, fourths = 0.0;
  for (Index k = 0; k < n; ++k) {
    const double place = static_cast<double>(std::min(k, n - 1 - k)) + 0.5;
    const double part = std::min(1.0, place / flank);
    const double sine = elementary::sin(0.5 * std::numbers::pi * part), square = sine * sine;
    const double weight = square * square;
    values(pad + k) *= weight;
    squares += weight * weight;
    fourths += weight * weight * weight * weight;
  }
  rest.spectrum = transform(values);
  rest.fourth = fourths / (squares * squares);
  return rest;
}

/// S/(S + N) of a signal in noise of power N = 1, where both together have been measured to have
/// `power`, give or take `chance`: S is the mean of power - 1 given that it is not negative, near
/// enough (the hyperbola that meets that of a normal deviate at 0 and far from it).
double wiener_gain(double power, double chance) {
  const double half = 0.5 * (power - 1.0);
  const double signal = half + std::sqrt(half * half + 2.0 / std::numbers::pi * chance * chance);
  return signal / (signal + 1.0);
}

/// Power in every bin over that of the noise, averaged over half a hertz.
constexpr double kSlow = std::numeric_limits<double>::infinity();  // where the motion is slow
struct Relative {
  Eigen::VectorXd power;
  double chance = 0.0;  ///< relative deviation of such a mean, of noise alone
};

Relative relative_of(const Rest& rest, double dt, Index length) {
  constexpr double kHalfBand = 0.25;   // Hz
  constexpr double kLeastShare = 0.5;  // of a bin's power, that tells what the rest is
  const Index bins = rest.spectrum.size();
  const Index half = std::max<Index>(4, std::llround(kHalfBand * dt * static_cast<double>(length)));
  const Eigen::VectorXd power = running_mean(rest.spectrum.cwiseAbs2(), half);
  std::vector<double> upper(power.begin() + bins / 2, power.end());
  std::nth_element(upper.begin(), upper.begin() + std::ptrdiff_t(upper.size() / 2), upper.end());
  const double noise = upper[upper.size() / 2];
  Relative relative{Eigen::VectorXd::Constant(bins, kSlow),
                    std::sqrt(rest.fourth * double(length) / (2.0 * double(half) + 1.0))};
  for (Index k = 0; k < bins && noise > 0.0; ++k) {
    if (rest.share(k) >= kLeastShare) relative.power(k) = power(k) / (noise * rest.share(k));
  }
  return relative;
}

/// What a mean of noise power with this relative deviation exceeds in one of a million cases: the
/// quantile of a gamma distribution (Wilson and Hilferty 1931).
double least_motion(double chance) {
  constexpr double kDeviations = 4.75;  // of a normal variable
  const double ninth = chance * chance / 9.0, root = 1.0 - ninth + kDeviations * chance / 3.0;
  return root * root * root;
}

/// The frequency up to which motion is slow: little noise passes two derivatives there.
double slow_hz(double cutoff_hz) { return std::min(3.0, cutoff_hz / 3.0); }

/// The frequency from which on a filter may pass more than its edge does: an edge there takes all
/// but a ten thousandth off the slow motion, of which a taper would leave more than moves.
double fast_hz(double cutoff_hz) { return 0.6 * cutoff_hz; }

/// Which of so many hertz, the last of which has no end, holds a frequency.
std::size_t hertz_of(double hz, std::size_t count) {
  return std::min(static_cast<std::size_t>(hz), count - 1);
}

/// The transform of a signal, its ends and reflections taken care of.
struct Transformed {
  Index n;
  double dt;
  EndCurves ends;
  Padded padded;
  Fourier transform;
  Eigen::VectorXcd spectrum;

  Transformed(const Eigen::Ref<const Eigen::VectorXd>& x, double step, double cutoff_hz)
      : n(x.size()),
        dt(step),
        ends(x, dt, cutoff_hz),
        padded(pad_oddly(x - ends.derivative(0), dt)),
        transform(length()),
        spectrum(transform(padded.values)) {}
  Index length() const { return padded.values.size(); }
  double hz(Index bin) const {
    return static_cast<double>(bin) / (static_cast<double>(length()) * dt);
  }
  Rest above(double from_hz) const {
    return rest_of(spectrum, length(), padded.pad, n, dt, from_hz, transform);
  }
};

/// A signal's spectrum behind the filter, the filter's gain in every bin, and whether motion beyond
/// the cut-off has passed.
struct Filtered {
  Eigen::VectorXcd spectrum;
  Eigen::VectorXd gain;
  bool is_fast = false;
};

Filtered filtered(const Transformed& x, const LowPass& filter) {
  const Index bins = x.spectrum.size();
  Filtered out{.spectrum = x.spectrum, .gain = Eigen::VectorXd::Ones(bins)};
  if (filter.subtraction > 0.0) {
    const Rest rest = x.above(slow_hz(filter.cutoff_hz));
    const Relative relative = relative_of(rest, x.dt, x.length());
    for (Index k = 0; k < bins; ++k) {
      if (relative.power(k) == kSlow) continue;
      out.gain(k) = wiener_gain(relative.power(k) / filter.subtraction, relative.chance);
      out.spectrum(k) -= (1.0 - out.gain(k)) * rest.spectrum(k);
    }
  }
  for (Index k = 0; k < bins; ++k) {
    const double passed = edge(x.hz(k), filter.cutoff_hz);
    out.spectrum(k) *= passed;
    out.gain(k) *= passed;
  }
  if (filter.most_noise.empty()) return out;
  const Rest rest = x.above(fast_hz(filter.cutoff_hz));
  const Relative relative = relative_of(rest, x.dt, x.length());
  const double chance = least_motion(relative.chance);
  for (Index k = 0; k < bins && x.hz(k) < filter.fastest_hz; ++k) {
    const std::size_t hertz = hertz_of(x.hz(k), filter.most_noise.size());
    const double least = filter.most_noise[hertz] * chance;
    if (relative.power(k) == kSlow || relative.power(k) < least) continue;
    const double more = wiener_gain(relative.power(k), relative.chance) - out.gain(k);
    if (more <= 0.0) continue;
    out.spectrum(k) += more / std::sqrt(rest.share(k)) * rest.spectrum(k);
    out.gain(k) += more;
    out.is_fast = true;
  }
  return out;
}

}  // namespace

Smoothed smooth(const Eigen::Ref<const Eigen::VectorXd>& signal, double dt, const LowPass& filter) {
  const Transformed x(signal, dt, filter.cutoff_hz);
  const Filtered passed = filtered(x, filter);
  const Eigen::VectorXcd& value = passed.spectrum;
  Eigen::VectorXcd first(value.size()), second(value.size());
  for (Index k = 0; k < value.size(); ++k) {
    const std::complex<double> s(0.0, 2.0 * std::numbers::pi * x.hz(k));
    first(k) = s * value(k);
    second(k) = s * first(k);
  }
  if (x.length() % 2 == 0) first(first.size() - 1) = 0.0;  // the Nyquist term has no derivative
  Smoothed out{x.transform.inverse(value).segment(x.padded.pad, x.n),
               x.transform.inverse(first).segment(x.padded.pad, x.n),
               x.transform.inverse(second).segment(x.padded.pad, x.n), passed.is_fast};
  out.value += x.ends.derivative(0);
  for (Index k = 0; k < x.n; ++k) {
    out.value(k) += x.padded.level + x.padded.slope * static_cast<double>(k);
  }
  out.first += x.ends.derivative(1);
  out.first.array() += x.padded.slope / dt;
  out.second += x.ends.derivative(2);
  return out;
}

Eigen::VectorXd gain_of(const Eigen::Ref<const Eigen::VectorXd>& x, double dt,
                        const LowPass& filter, Index steps) {
  const Eigen::VectorXd gain = filtered(Transformed(x, dt, filter.cutoff_hz), filter).gain;
  Eigen::VectorXd out(steps);
  for (Index k = 0; k < steps; ++k) {
    const Index first = k * (gain.size() - 1) / steps, end = (k + 1) * (gain.size() - 1) / steps;
    out(k) = gain.segment(first, std::max<Index>(1, end - first)).mean();
  }
  return out;
}

std::vector<double> most_noise(const Eigen::Ref<const Eigen::VectorXd>& signal, double dt,
                               const LowPass& filter) {
  const Transformed x(signal, dt, filter.cutoff_hz);
  const Relative relative = relative_of(x.above(fast_hz(filter.cutoff_hz)), dt, x.length());
  std::vector<double> most(static_cast<std::size_t>(std::max(1.0, std::ceil(filter.fastest_hz))));
  for (Index k = 0; k < relative.power.size() && x.hz(k) < filter.fastest_hz; ++k) {
    double& here = most[hertz_of(x.hz(k), most.size())];
    if (relative.power(k) < kSlow) here = std::max(here, relative.power(k));
  }
  for (std::size_t k = most.size() - 1; k-- > 0;) most[k] = std::max(most[k], most[k + 1]);
  return most;
}

}  // namespace dcnn
