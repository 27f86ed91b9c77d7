// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/noise_floor.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "data/median.h"
#include "diagnosis/floor_fit.h"
#include "diagnosis/noise_shapes.h"

namespace dcnn {
namespace {

constexpr double kLeastOfDifferences = 1e-6;
constexpr Index kFewestBins = 12;   // below this the quiet band says nothing
constexpr double kLeastSeen = 0.1;  // of the noise's power, that interpolation leaves of a bin

/// Variance of white noise with these second differences; where no three rows follow each other,
/// of all that is there.
double variance_of_differences(const Case& study, const Signals& signals, Index channel) {
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < signals.size(); ++k) {
    const auto x = signals[k].col(channel);
    for (const Segment& s : study.logs[k].motion.segments) {
      for (Index i = s.begin + 2; i < s.end; ++i, ++count) {
        const double d = x(i) - 2.0 * x(i - 1) + x(i - 2);
        sum += d * d / 6.0;
      }
    }
  }
  if (count > 0.0) return sum / count;
  for (const auto& x : signals) {
    sum += x.col(channel).squaredNorm();
    count += static_cast<double>(x.rows());
  }
  return sum / count;
}

/// Lines replaced by the level beside them.
Eigen::VectorXd without_lines(const Eigen::VectorXd& density, double windows) {
  constexpr Index kBeside = 10;  // bins
  // What chance alone reaches in one bin of a thousand: the upper middle of n exponential variables
  // over its median is above 10, 6, 5 and 3.5 for n = 1, 2, 3 and 15.
  const double most = 3.0 + 7.0 / windows;
  Eigen::VectorXd smooth = density;
  for (Index i = 0; i < density.size(); ++i) {
    const Index first = std::max<Index>(0, i - kBeside);
    const Index last = std::min(density.size(), i + kBeside + 1);
    const double level = median({density.data() + first, density.data() + last});
    smooth(i) = density(i) < most * level ? density(i) : level;
  }
  return smooth;
}

std::vector<Index> bins_between(const Periodograms& p, double from, double to) {
  std::vector<Index> bins;
  for (Index i = 0; i < p.hz.size(); ++i) {
    if (p.hz(i) >= from && p.hz(i) <= to) bins.push_back(i);
  }
  return bins;
}

/// ln of the likelihood of a density under a floor's shape, per window of independent bins.
double log_likelihood(const Eigen::VectorXd& density, const Eigen::VectorXd& hz, const Floor& floor,
                      double windows) {
  const Eigen::VectorXd shape = hz.unaryExpr([&](double f) { return floor.density(f); });
  return fit_level(density, shape, windows).likelihood;
}

/// The mean over the recordings of what interpolation made of their noise.
std::vector<double> interpolation_of(const Case& study) {
  std::vector<double> mean;
  double rows = 0.0;
  for (const Log& log : study.logs)
    mean.resize(std::max(mean.size(), log.recording.interpolated.size()));
  for (const Log& log : study.logs) {
    if (mean.empty()) break;
    const auto own = static_cast<double>(log.motion.samples());
    const std::vector<double>& covariance = log.recording.interpolated;
    if (covariance.empty()) mean.front() += own;
    for (std::size_t lag = 0; lag < covariance.size(); ++lag) mean[lag] += own * covariance[lag];
    rows += own;
  }
  for (double& c : mean) c /= rows;
  return mean;
}

/// A density as it was before interpolation, where that left some of it.
Eigen::VectorXd before_interpolation(const Eigen::VectorXd& density, const Eigen::VectorXd& hz,
                                     const std::vector<double>& interpolated, double dt) {
  return density.array() / hz.array().unaryExpr([&](double f) {
    return std::max(kLeastSeen, interpolated_shape(interpolated, f, dt));
  });
}

}  // namespace

void add_rounding(const Case& study, std::vector<Floor>& floors) {
  const double q = study.rounding_step, s = study.rounding_noise;
  for (std::size_t j = 0; j < floors.size(); ++j) {
    Floor& floor = floors[j];
    floor.rounding = 0.0;
    const double known = floor.deviation();
    if (study.is_rounded(static_cast<Index>(j)))
      floor.rounding = std::max(0.0, q * q / 12.0 + s * s - known * known);
  }
}

double quiet_band(const Case& study) {
  const double most = study.motion_hz > 20.0 ? 0.35 : 0.2;  // of the rate
  return std::min(study.motion_hz, most / study.dt());
}

std::vector<Floor> noise_floor(const Case& study, const Signals& residual, const Signals& levels) {
  if (study.is_static()) return floor_at_rest(study, residual);
  const Signals even = evened(study, residual, levels);
  const double dt = study.dt(), from = quiet_band(study), to = 0.49 / dt;
  const std::vector<double> interpolated = interpolation_of(study);
  std::vector<Floor> floors;
  std::vector<QuietBand> bands;
  for (Index channel = 0; channel < study.channel_count(); ++channel) {
    const Periodograms p = periodograms(study, even, channel);
    const Eigen::VectorXd density =
        before_interpolation(density_of(p, study.rounding_step > 0.0), p.hz, interpolated, dt);
    QuietBand& band = bands.emplace_back();
    const auto slow = slow_bins(study, even, channel);
    std::vector<Index> quiet = bins_between(p, from, to);
    std::erase_if(
        quiet, [&](Index i) { return interpolated_shape(interpolated, p.hz(i), dt) < kLeastSeen; });
    Floor floor;
    if (static_cast<Index>(quiet.size()) >= kFewestBins && p.power.cols() > 0) {
      const auto windows = static_cast<double>(p.power.cols());
      const Eigen::VectorXd all = density(quiet);
      band = {without_lines(all, windows), p.hz(quiet), windows};
      floor = fit_floor(band.density, band.hz, dt, windows, study.without.coloured_floor,
                        [&](const Floor& shape) { return exceeds(shape, p, density, slow); });
      floor.lines = (all - band.density).sum() / static_cast<double>(density.size());
      floor.source = "spectrum of the residual above " +
                     std::to_string(static_cast<int>(std::lround(from))) + " Hz";
    }
    // Without a quiet band, or where most windows hold one value that is read again and again.
    const double differences = variance_of_differences(study, even, channel);
    if (floor.white + floor.coloured + floor.filtered + floor.flicker <
        kLeastOfDifferences * differences) {
      floor = Floor{.white = differences, .source = "second differences of the residual"};
      band = {};
    }
    floor.dt = dt;
    floors.push_back(floor);
  }
  const bool shared = share_colours(bands, floors);
  for (Floor& floor : floors) {
    floor.lowpass_hz = study.lowpass_hz;
    floor.interpolated = interpolated;
  }
  if (shared) bound_by_residual(study, residual, levels, floors);
  return floors;
}

std::vector<double> quiet_density(const Case& study, const Signals& residual,
                                  const Signals& levels) {
  const Signals even = evened(study, residual, levels);
  std::vector<double> list;
  for (Index channel = 0; channel < study.channel_count(); ++channel) {
    const Periodograms p = periodograms(study, even, channel);
    const std::vector<Index> quiet = bins_between(p, quiet_band(study), 0.49 / study.dt());
    const bool told = static_cast<Index>(quiet.size()) >= kFewestBins && p.power.cols() > 0;
    const Eigen::VectorXd density = density_of(p, study.rounding_step > 0.0);
    list.push_back(told ? without_lines(density(quiet), double(p.power.cols())).mean() : 0.0);
  }
  return list;
}

std::optional<std::vector<Floor>> noise_of_all(const Case& study, const Signals& residual,
                                               const Signals& levels,
                                               const std::vector<Floor>& known) {
  // One bin in 1.5 is independent behind the window, and a median knows half of what a mean does.
  constexpr double kIndependent = 1.0 / (1.5 * 2.08);
  constexpr double kRefuted = 8.1;   // half of the 99.9 % quantile of chi-square, 3 degrees
  constexpr double kLeastOwn = 0.1;  // of what is left, that is the sensor's: tolerance
  const Signals even = evened(study, residual, levels);
  const double dt = study.dt(), from = quiet_band(study), to = 0.49 / dt;
  const std::vector<double> interpolated = interpolation_of(study);
  std::vector<Floor> floors;
  for (Index channel = 0; channel < study.channel_count(); ++channel) {
    const Periodograms p = periodograms(study, even, channel);
    if (p.power.cols() == 0) return std::nullopt;
    const auto windows = static_cast<double>(p.power.cols());
    Eigen::VectorXd density = density_of(p, study.rounding_step > 0.0);
    for (Index i = 0; i < density.size(); ++i) {
      const double of_pose = known[static_cast<std::size_t>(channel)].pose_density(p.hz(i));
      density(i) = std::max(density(i) - of_pose, kLeastOwn * density(i));
    }
    density = before_interpolation(density, p.hz, interpolated, dt);
    const auto slow = slow_bins(study, even, channel);
    const auto fitted = [&](const std::vector<Index>& bins) {
      Floor floor = fit_floor(without_lines(density(bins), windows), p.hz(bins), dt, windows, false,
                              [&](const Floor& shape) { return exceeds(shape, p, density, slow); });
      floor.dt = dt;
      return floor;
    };
    const std::vector<Index> quiet = bins_between(p, from, to);
    // The window takes the mean off the two lowest bins.
    const std::vector<Index> all = bins_between(p, p.hz(2), to);
    if (static_cast<Index>(quiet.size()) < kFewestBins) return std::nullopt;
    Floor floor = fitted(all);
    const Eigen::VectorXd above = without_lines(density(quiet), windows);
    const double best = log_likelihood(above, p.hz(quiet), fitted(quiet), kIndependent * windows);
    const double own = log_likelihood(above, p.hz(quiet), floor, kIndependent * windows);
    if (best - own > kRefuted) return std::nullopt;
    floor.source = "spectrum of the residual in all, which the band above " +
                   std::to_string(static_cast<int>(std::lround(from))) + " Hz bears out";
    floor.lowpass_hz = study.lowpass_hz;
    floor.interpolated = interpolated;
    floors.push_back(floor);
  }
  return floors;
}

}  // namespace dcnn
