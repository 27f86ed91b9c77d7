#include "data/spectral.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "dcnn/data/fourier.h"

namespace dcnn {
namespace {

constexpr double kPadSeconds = 2.0;

/// The signal with its odd reflections at both ends, less the line through the first and last of
/// all these samples, and zeros up to a length that transforms fast: continuous around the circle.
struct Padded {
  Eigen::VectorXd values;
  Index pad = 0;
  double level = 0.0, slope = 0.0;  // of the line, at the first sample of the signal and per sample
};

Padded pad_oddly(const Eigen::Ref<const Eigen::VectorXd>& x, double dt) {
  const Index n = x.size();
  Padded padded;
  padded.pad = std::min<Index>(n - 1, std::llround(kPadSeconds / dt));
  const Index length = n + 2 * padded.pad;
  padded.values.setZero(fast_length(length));
  padded.values.segment(padded.pad, n) = x;
  for (Index k = 1; k <= padded.pad; ++k) {
    padded.values(padded.pad - k) = 2.0 * x(0) - x(k);
    padded.values(padded.pad + n - 1 + k) = 2.0 * x(n - 1) - x(n - 1 - k);
  }
  const double first = padded.values(0), last = padded.values(length - 1);
  padded.slope = length > 1 ? (last - first) / static_cast<double>(length - 1) : 0.0;
  for (Index k = 0; k < length; ++k) {
    padded.values(k) -= first + padded.slope * static_cast<double>(k);
  }
  padded.level = first + padded.slope * static_cast<double>(padded.pad);
  return padded;
}

}  // namespace

Smoothed smooth(const Eigen::Ref<const Eigen::VectorXd>& x, double dt, double cutoff_hz) {
  const Index n = x.size();
  const Padded padded = pad_oddly(x, dt);
  const Index length = padded.values.size();
  const Eigen::VectorXcd spectrum = fourier(padded.values);
  Eigen::VectorXcd value(spectrum.size()), first(spectrum.size()), second(spectrum.size());
  for (Index k = 0; k < spectrum.size(); ++k) {
    const double hz = static_cast<double>(k) / (static_cast<double>(length) * dt);
    const double gain = 1.0 / (1.0 + std::pow(hz / cutoff_hz, 8.0));
    const std::complex<double> s(0.0, 2.0 * std::numbers::pi * hz);
    value(k) = gain * spectrum(k);
    first(k) = s * value(k);
    second(k) = s * first(k);
  }
  if (length % 2 == 0) first(first.size() - 1) = 0.0;  // the Nyquist term has no derivative
  Smoothed out{inverse_fourier(value, length).segment(padded.pad, n),
               inverse_fourier(first, length).segment(padded.pad, n),
               inverse_fourier(second, length).segment(padded.pad, n)};
  for (Index k = 0; k < n; ++k)
    out.value(k) += padded.level + padded.slope * static_cast<double>(k);
  out.first.array() += padded.slope / dt;
  return out;
}

}  // namespace dcnn
