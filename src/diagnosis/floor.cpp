// SPDX-License-Identifier: Apache-2.0
// The density of a floor, and what it integrates to.
#include <algorithm>
#include <cmath>
#include <complex>

#include "core/elementary.h"
#include "diagnosis/noise_floor.h"
#include "diagnosis/noise_shapes.h"

namespace dcnn {
namespace {

constexpr double kSlowest = 0.02;   // Hz: flicker noise is taken for flat below
constexpr int kFloorPoints = 8192;  // of integrals over frequency

/// The factor at a frequency: on straight lines over log f, constant beyond the ends.
double bound_at(const std::vector<std::pair<double, double>>& bounds, double hz) {
  if (bounds.empty()) return 1.0;
  if (hz <= bounds.front().first) return bounds.front().second;
  for (std::size_t k = 1; k < bounds.size(); ++k) {
    const auto& [from, low] = bounds[k - 1];
    const auto& [to, high] = bounds[k];
    if (hz < to)
      return low + (high - low) * elementary::log(hz / from) / elementary::log(to / from);
  }
  return bounds.back().second;
}

double power_law(double at_one, double slope, double hz) {
  const double from = std::max(hz, kSlowest);
  return at_one / (slope == 1.0 ? from : elementary::pow(from, slope));
}

}  // namespace

void Floor::amplify(double factor) {
  for (double* part : {&white, &coloured, &filtered, &flicker, &power, &markov, &lines}) {
    *part *= factor;
  }
}

double Floor::deviation() const {
  if (lowpass_hz == 0.0 && filtered == 0.0 && !is_slow() && bounds.empty() && interpolated.empty())
    return std::sqrt(white + coloured + lines + rounding);
  double sum = 0.0;
  for (int i = 0; i < kFloorPoints; ++i) sum += density((i + 0.5) / kFloorPoints * 0.5 / dt);
  return std::sqrt(sum / kFloorPoints + lines + rounding);
}

double Floor::pose_variance() const {
  if (pose_gain.empty()) return 0.0;
  double sum = 0.0;
  for (int i = 0; i < kFloorPoints; ++i) sum += pose_density((i + 0.5) / kFloorPoints * 0.5 / dt);
  return sum / kFloorPoints;
}

double Floor::whole_deviation() const {
  if (pose_gain.empty()) return deviation();
  const double sensor = deviation();
  return std::sqrt(sensor * sensor + pose_variance());
}

double Floor::density(double hz) const {
  const double fitted = white + (coloured > 0.0 ? coloured * ar_shape(rho, hz, dt) : 0.0) +
                        filtered * filter_shape(filter_hz, hz) + flicker / std::max(hz, kSlowest) +
                        (power > 0.0 ? power_law(power, slope, hz) : 0.0) +
                        markov / (1.0 + (hz / corner_hz) * (hz / corner_hz));
  const double plain = fitted * bound_at(bounds, hz) * interpolated_shape(interpolated, hz, dt);
  if (lowpass_hz == 0.0) return plain;
  const double gain =
      1.0 / (1.0 + elementary::pow(hz / lowpass_hz, 8.0));  // Butterworth, there and back
  return plain * gain * gain;
}

double Floor::power_deviation(double seconds) const {
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kFloorPoints; ++i) {
    const double hz = (i + 0.5) / kFloorPoints * 0.5 / dt;
    const double all = density(hz) + pose_density(hz);
    sum += all;
    squares += all * all;
  }
  // (integral of S^2)/(T (integral of S)^2) over frequencies up to 1/(2 dt) (Bendat and Piersol,
  // Random Data, 2010, 8.3).
  const double bandwidth = 0.5 / dt;
  const double variance = squares * kFloorPoints / (sum * sum * bandwidth * seconds);
  return sum > 0.0 ? std::sqrt(variance) : 0.0;
}

double Floor::pose_density(double hz) const {
  if (pose_gain.empty()) return 0.0;
  const double place = 2.0 * hz * dt * static_cast<double>(pose_gain.size());
  const auto step = std::min(pose_gain.size() - 1, static_cast<std::size_t>(place));
  const double w = 2.0 * std::numbers::pi * hz;
  double rung = 1.0;
  for (const Mode& mode : modes) {
    const double r = hz / mode.hz;
    const std::complex<double> below(1.0 - r * r, 2.0 * mode.zeta * r);
    rung *= std::norm(1.0 + mode.fraction * (1.0 / below - 1.0));
  }
  return rung * (static_part + moving_part * w * w * w * w) * pose_gain[step];
}

}  // namespace dcnn
