// SPDX-License-Identifier: Apache-2.0
// What a family of scenarios adds to the plain conditions: tremor, noise, clocks.
#include <cmath>
#include <numbers>

#include "conceal/draws.h"
#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
constexpr double kCircle = 2.0 * std::numbers::pi;

void draw_tremor(Conditions& c, Rng& rng) {
  c.tremor_hz = rng.uniform(4.0, 14.0);
  c.tremor_width_hz = rng.uniform(0.5, 2.0);
  // Displacement falls with frequency: rms of 0.05 to 1 mm at 8 Hz, of the angles 0.3 to 6 mrad.
  const double fall = (8.0 / c.tremor_hz) * (8.0 / c.tremor_hz);
  c.tremor_m = fall * logarithmic(rng, 5e-5, 1e-3);
  c.tremor_rad = fall * logarithmic(rng, 3e-4, 6e-3);
  c.tremor_period_s = rng.uniform() < 0.4 ? rng.uniform(4.0, 15.0) : 0.0;
}

void draw_load(Conditions& c, Rng& rng) {
  for (int j = 0; j < 3; ++j) c.axis(j) = logarithmic(rng, 0.5, 2.0);
  c.growth = rng.uniform(0.02, 0.3);
  c.burst = rng.uniform() < 0.4 ? rng.uniform(1.5, 4.0) : 1.0;
}

void draw_clock(Conditions& c, Rng& rng) {
  c.samples_per_reading = one_of<int>(rng, {20, 16, 10, 8, 5, 4, 2});
  c.lost = rng.uniform() < 0.7 ? logarithmic(rng, 0.001, 0.02) : 0.0;
  c.jitter = rng.uniform() < 0.4 ? rng.uniform(0.01, 0.05) : 0.0;
}

/// A resonance of two poles at `hz`, `width` wide (half power), in place.
void resonate(Eigen::VectorXd& x, double hz, double width) {
  const double r = elementary::exp(-std::numbers::pi * width * kStep);
  const double a = 2.0 * r * elementary::cos(kCircle * hz * kStep), b = -r * r;
  double before = 0.0, earlier = 0.0;
  for (double& now : x) {
    now += a * before + b * earlier;
    earlier = before;
    before = now;
  }
}

/// Gaussian noise of unit deviation in a band. Three resonances in a row: above the band even its
/// acceleration falls as 1/f^4, as of a hand with a mass.
Eigen::VectorXd band_noise(Index n, double hz, double width, Rng& rng) {
  constexpr Index kRunIn = 40000;
  Eigen::VectorXd x(n + kRunIn);
  for (double& e : x) e = rng.normal();
  for (int pass = 0; pass < 3; ++pass) resonate(x, hz, width);
  const Eigen::VectorXd steady = x.tail(n);
  return steady / std::max(1e-300, std::sqrt(steady.squaredNorm() / static_cast<double>(n)));
}

}  // namespace

const std::vector<std::string>& families() {
  static const std::vector<std::string> all{"plain", "tremor",   "load",  "clock",
                                            "field", "hardware", "wrench"};
  return all;
}

Conditions draw_conditions(const std::string& family, Rng& rng) {
  Conditions c;
  c.family = family;
  const bool all = family == "field";
  if (family == "tremor" || (all && rng.uniform() < 0.5)) draw_tremor(c, rng);
  if (family == "load" || (all && rng.uniform() < 0.5)) draw_load(c, rng);
  if (family == "clock" || (all && rng.uniform() < 0.5)) draw_clock(c, rng);
  if (family == "wrench") c.torque_m = logarithmic(rng, 0.02, 0.15);
  if (all) c.seconds = rng.uniform(12.0, 60.0);
  return c;
}

void add_tremor(const Conditions& c, Eigen::MatrixXd& pose, Rng& rng) {
  if (c.tremor_m == 0.0) return;
  const double phase = rng.uniform(0.0, kCircle);
  for (int j = 0; j < 6; ++j) {
    const double size = (j < 3 ? c.tremor_m : c.tremor_rad) * rng.uniform(0.4, 1.0);
    Eigen::VectorXd x = size * band_noise(pose.rows(), c.tremor_hz, c.tremor_width_hz, rng);
    for (Index i = 0; i < x.size() && c.tremor_period_s > 0.0; ++i) {
      const double wave =
          elementary::sin(kCircle * kStep * static_cast<double>(i) / c.tremor_period_s + phase);
      x(i) /= 1.0 + elementary::exp(-(wave - 0.2) / 0.1);
    }
    pose.col(j) += x;
  }
}

Eigen::MatrixXd noise_scale(const Conditions& c, const Eigen::MatrixXd& force, Rng& rng) {
  Eigen::MatrixXd scale = Eigen::MatrixXd::Constant(force.rows(), force.cols(), c.torque_m);
  const auto second = static_cast<Index>(c.hz());
  double burst = 1.0;
  for (Index i = 0; i < force.rows(); ++i) {
    if (c.burst > 1.0 && i % second == 0) burst = rng.uniform() < 1.0 / 6.0 ? c.burst : 1.0;
    for (int j = 0; j < 3; ++j) {
      scale(i, j) = burst * c.axis(j) * (1.0 + c.growth * std::abs(force(i, j)));
    }
  }
  return scale;
}

std::vector<Index> kept_rows(const Conditions& c, Index rows, Rng& rng) {
  std::vector<Index> kept;
  Index gone = 0;
  for (Index i = 0; i < rows; ++i) {
    // The mean run is 1.4 rows long.
    if (c.lost > 0.0 && gone == 0 && rng.uniform() < c.lost / 1.4) {
      const double run = rng.uniform();
      gone = run < 0.7 ? 1 : run < 0.9 ? 2 : 3;
    }
    if (gone > 0 && i > 0 && i + 1 < rows) {
      --gone;
    } else {
      kept.push_back(i);
    }
  }
  return kept;
}

}  // namespace dcnn::conceal
