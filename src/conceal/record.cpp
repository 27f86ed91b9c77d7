// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "conceal/draws.h"
#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;

/// Unit deviation per sample, but for the events of `heavy` and the swell of `heteroscedastic`.
class NoiseSource {
 public:
  NoiseSource(std::string kind, Rng& rng) : kind_(std::move(kind)), rng_(rng) {
    state_ = rng.normal();
    for (double& s : slow_) s = rng.normal();
  }

  double next(Index i) {
    double x = rng_.normal();
    if (kind_ == "ar1") x = state_ = 0.8 * state_ + 0.6 * x;
    if (kind_ == "heteroscedastic") {
      x *= 1.0 + 0.6 * elementary::sin(2.0 * std::numbers::pi * static_cast<double>(i) / 6000.0);
    }
    if (kind_ == "heavy" && rng_.uniform() < 0.01) x *= 6.0;
    if (kind_ == "flicker") {  // 1/f below some 1 Hz: one pole per factor of four
      constexpr double kHz[4] = {0.02, 0.08, 0.32, 1.28};
      for (int k = 0; k < 4; ++k) {
        const double keep = elementary::exp(-2.0 * std::numbers::pi * kHz[k] / 500.0);
        slow_[k] = keep * slow_[k] + std::sqrt(1.0 - keep * keep) * rng_.normal();
        x += 0.05 * slow_[k];
      }
    }
    return x;
  }

 private:
  std::string kind_;
  Rng& rng_;
  double state_, slow_[4];
};

/// Of a sensor that would read `clean` (T, 3 or 6).
Eigen::MatrixXd sensor_noise(const Scenario& s, const Eigen::MatrixXd& clean, Rng& rng) {
  Eigen::MatrixXd e(clean.rows(), clean.cols());
  for (Index j = 0; j < e.cols(); ++j) {
    NoiseSource source(s.noise.kind, rng);
    for (Index i = 0; i < e.rows(); ++i) e(i, j) = s.noise.sigma * source.next(i);
  }
  return e.cwiseProduct(noise_scale(s.conditions, clean, rng));
}

/// As a logger prints: decimals well below every noise.
double printed(double value, double digits) { return std::round(value * digits) / digits; }

void read_pose(const Path& path, const Scenario& s, bool thermometer, Recorded& r, Rng& rng) {
  const Index n = r.measured.rows();
  const Noise& noise = s.noise;
  const double step = 1.0 / s.conditions.hz();
  r.t.resize(n);
  r.pose.resize(n, 6);
  if (thermometer) r.temperature.resize(n);
  for (Index i = 0; i < n; ++i) {
    const Index k = i * s.conditions.samples_per_reading;
    const double late = s.conditions.jitter > 0.0 ? s.conditions.jitter * step * rng.normal() : 0.0;
    r.t(i) = printed(path.time(k) + late, 1e6);
    for (Index j = 0; j < 6; ++j) {
      const double sigma = j < 3 ? noise.pose_m : noise.pose_rad;
      r.pose(i, j) = printed(path.pose(k, j) + sigma * rng.normal(), 1e8);
    }
    if (thermometer) {
      r.temperature(i) = printed(path.climate(path.time(k)) + 0.01 * rng.normal(), 1e4);
    }
  }
}

/// Leaves out the rows that were lost.
void lose_rows(const Conditions& conditions, Recorded& r, Rng& rng) {
  const auto kept = kept_rows(conditions, r.t.size(), rng);
  for (Eigen::MatrixXd* block : {&r.pose, &r.measured, &r.clean}) {
    *block = Eigen::MatrixXd((*block)(kept, Eigen::all));
  }
  for (Eigen::VectorXd* column : {&r.t, &r.temperature}) {
    if (column->size() > 0) *column = Eigen::VectorXd((*column)(kept));
  }
}

std::vector<Hidden> without_rounding(std::vector<Hidden> hidden) {
  std::erase_if(hidden, [](const Hidden& h) { return h.effect == "quantisation"; });
  return hidden;
}

}  // namespace

double next_start(double end) { return std::ceil(end + 5.0); }

void record(const Scenario& s, const Path& path, bool thermometer, Recorded& r, Rng& rng) {
  const double lattice = s.noise.kind == "quantised" ? 2e3 : 1e7;
  const int stride = s.conditions.samples_per_reading;
  r.clean = reading(path, s.tool, without_rounding(s.hidden), {}, stride);
  r.measured = reading(path, s.tool, s.hidden, sensor_noise(s, r.clean, rng), stride);
  for (Index j = 0; j < r.measured.cols(); ++j) {
    const double digits = j < 3 ? lattice : lattice / s.conditions.torque_m;
    for (double& f : r.measured.col(j)) f = printed(f, digits);
  }
  read_pose(path, s, thermometer, r, rng);
  if (s.conditions.lost > 0.0) lose_rows(s.conditions, r, rng);
}

void record(Scenario& s, const std::vector<Path>& paths, bool thermometer, Rng& rng) {
  for (std::size_t k = 0; k < paths.size(); ++k)
    record(s, paths[k], thermometer, s.recordings[k], rng);
}

void record_on(Scenario& scenario, const Recording& motion, std::uint64_t seed) {
  Path path = path_of(motion, scenario.tool.mounting);
  double end = 0.0;
  std::size_t fitted = 0;
  for (const Recorded& r : scenario.recordings) {
    end = std::max(end, r.t.maxCoeff());
    fitted += r.holdout ? 0 : 1;
  }
  path.start = next_start(end);
  path.climate = scenario.climate;
  const double last = path.time(path.samples() - scenario.conditions.samples_per_reading);
  for (Hidden& h : scenario.hidden) {
    if (h.effect == "step_bias" && h.interval_s) h.interval_s->second = last;
  }
  Recorded next;
  next.name = "fit_" + std::to_string(fitted);
  const bool thermometer = scenario.recordings.front().temperature.size() > 0;
  Rng rng({seed, 14, scenario.recordings.size()});
  record(scenario, path, thermometer, next, rng);
  scenario.recordings.push_back(std::move(next));
}

}  // namespace dcnn::conceal
