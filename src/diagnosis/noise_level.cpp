// SPDX-License-Identifier: Apache-2.0
// How the level of each channel's noise varies over a recording: with the force it reads, and in
// bursts.
#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "diagnosis/noise_floor.h"
#include "diagnosis/rest.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr double kSeconds = 0.5;
// Relative deviation of a mean of n absolute second differences of white noise, times sqrt(n):
// 0.756 of one, sqrt(2) for their correlation.
constexpr double kOfMean = 1.07;

struct Window {
  std::size_t log;
  Index begin, end;
  double level;  ///< logarithm of the mean absolute second difference
  double load;   ///< mean of the load's covariate
  double variance() const { return kOfMean * kOfMean / static_cast<double>(end - begin); }
};

/// log(1 + |F|/knee) of the predicted force F.
double covariate(double force, double knee) { return elementary::log1p(std::abs(force) / knee); }

/// Whether a reading repeats its last value so often that its steps hide its noise: noise of
/// deviation s in steps of s repeats a value with probability 1/(2 sqrt(pi)) = 0.28. Its second
/// differences tell when the value was renewed, not how noisy it is.
bool steps_hide_noise(const Case& study, Index channel) {
  constexpr double kRepeated = 0.28;
  double same = 0.0, rows = 0.0;
  for (const Log& log : study.logs) {
    const Eigen::MatrixXd& all = log.unfiltered.rows() > 0 ? log.unfiltered : log.measured;
    const auto x = all.col(channel);
    for (Index i = 1; i < x.size(); ++i, ++rows) same += x(i) == x(i - 1) ? 1.0 : 0.0;
  }
  return same > kRepeated * rows;
}

std::vector<Window> windows_of(const Case& study, const Signals& residual, Index channel) {
  const Index n = std::max<Index>(8, std::llround(kSeconds / study.dt()));
  std::vector<Window> windows;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const auto r = residual[k].col(channel);
    for (const Segment& s : study.logs[k].motion.segments) {
      for (Index begin = s.begin; begin < s.end; begin += n) {
        const Index end = std::min(begin + n, s.end), first = std::max(begin, s.begin + 2);
        double sum = 0.0;
        for (Index i = first; i < end; ++i) sum += std::abs(r(i) - 2.0 * r(i - 1) + r(i - 2));
        const double mean = end > first ? sum / static_cast<double>(end - first) : 0.0;
        windows.push_back({k, begin, end, mean > 0.0 ? elementary::log(mean) : -kInfinity, 0.0});
      }
    }
  }
  return windows;
}

/// level = mean + slope (load - mean load), weighted by the windows' own variances.
struct Line {
  double level = 0.0, load = 0.0, slope = 0.0;
  double gain = 0.0;  ///< of chi-square, by the slope
};

Line fit_line(const std::vector<Window>& windows) {
  Line line;
  double weights = 0.0, xx = 0.0, xy = 0.0;
  for (const Window& w : windows) {
    if (!std::isfinite(w.level)) continue;
    weights += 1.0 / w.variance();
    line.level += w.level / w.variance();
    line.load += w.load / w.variance();
  }
  if (weights == 0.0) return line;
  line.level /= weights;
  line.load /= weights;
  for (const Window& w : windows) {
    if (!std::isfinite(w.level)) continue;
    xx += (w.load - line.load) * (w.load - line.load) / w.variance();
    xy += (w.load - line.load) * (w.level - line.level) / w.variance();
  }
  if (xx <= 0.0) return line;
  line.slope = xy / xx;
  line.gain = xy * xy / xx;
  return line;
}

/// The share of an estimate that James and Stein keep of one with so large a square, in units of
/// its variance, where chance alone makes `chance` of it.
double kept(double square, double chance) { return square > chance ? 1.0 - chance / square : 0.0; }

/// The line whose knee, relative to the rms of the force, fits best; the windows' loads become its.
Line best_line(const Signals& force, Index channel, double* knee, std::vector<Window>& windows) {
  double square = 0.0, rows = 0.0;
  for (const auto& f : force) square += f.col(channel).squaredNorm(), rows += double(f.rows());
  const double rms = std::sqrt(square / std::max(1.0, rows));
  Line best;
  std::vector<Window> chosen = windows;
  for (const double relative : {0.1, 0.3, 1.0, 3.0}) {
    if (rms == 0.0) break;
    for (Window& w : windows) {
      w.load = 0.0;
      for (Index i = w.begin; i < w.end; ++i) {
        w.load += covariate(force[w.log](i, channel), relative * rms) / double(w.end - w.begin);
      }
    }
    const Line line = fit_line(windows);
    if (line.gain >= best.gain) best = line, chosen = windows, *knee = relative * rms;
  }
  windows = std::move(chosen);
  // A burst that lasts is one observation, not one a window.
  constexpr double kWindowsOfBurst = 4.0;
  double scatter = 0.0, count = 0.0;
  for (const Window& w : windows) {
    if (!std::isfinite(w.level)) continue;
    const double off = w.level - best.level - best.slope * (w.load - best.load);
    scatter += off * off / w.variance(), ++count;
  }
  const double inflation = std::max(1.0, kWindowsOfBurst * scatter / std::max(1.0, count - 2.0));
  best.slope *= kept(best.gain / inflation, 4.0);
  return best;
}

/// Fills column `channel` of the levels.
void level_of(const Case& study, const Signals& residual, const Signals& force, Index channel,
              const std::vector<Span>& resting, Signals& levels) {
  std::vector<Window> windows = windows_of(study, residual, channel);
  double knee = 1.0;
  Line line = best_line(force, channel, &knee, windows);
  if (line.slope == 0.0) line = fit_line(windows), line.slope = 0.0;
  double scatter = 0.0, expected = 0.0;
  for (const Window& w : windows) {
    if (!std::isfinite(w.level)) continue;
    const double off = w.level - line.level - line.slope * (w.load - line.load);
    scatter += off * off, expected += w.variance();
  }
  // The spread of the expected scatter over so many windows is part of chance.
  const auto count = static_cast<double>(std::max<std::size_t>(1, windows.size()));
  const double share = kept(scatter, expected * (1.0 + 2.0 * std::sqrt(2.0 / count)));
  // Windows of a steady oscillation have one mean load: the line is known over their loads alone.
  double lowest = kInfinity, highest = -kInfinity;
  for (const Window& w : windows) {
    if (!std::isfinite(w.level)) continue;
    lowest = std::min(lowest, w.load), highest = std::max(highest, w.load);
  }
  constexpr double kLeast = -7.0;  // logarithm of a level, where the log repeats one value
  double power = 0.0, rows = 0.0;
  for (const Window& w : windows) {
    const double middle = study.logs[w.log].motion.t((w.begin + w.end) / 2);
    const bool counts = std::none_of(resting.begin(), resting.end(),
                                     [&](const Span& span) { return span.holds(w.log, middle); });
    const double own = std::isfinite(w.level) ? w.level - line.level : kLeast;
    const double burst = share * (own - line.slope * (w.load - line.load));
    for (Index i = w.begin; i < w.end; ++i) {
      double log_level = burst;
      if (line.slope != 0.0) {
        const double load = covariate(force[w.log](i, channel), knee);
        log_level += line.slope * (std::min(std::max(load, lowest), highest) - line.load);
      }
      const double level = elementary::exp(std::clamp(log_level, kLeast, -kLeast));
      levels[w.log](i, channel) = level;
      if (counts) power += level * level, ++rows;
    }
  }
  const double scale = std::sqrt(power / std::max(1.0, rows));
  for (auto& level : levels) level.col(channel) /= scale > 0.0 ? scale : 1.0;
}

}  // namespace

Signals noise_level(const Case& study, const Signals& residual) {
  Signals levels, force;
  for (std::size_t k = 0; k < residual.size(); ++k) {
    levels.push_back(Eigen::MatrixXd::Ones(residual[k].rows(), residual[k].cols()));
    force.push_back(study.logs[k].measured - residual[k]);
  }
  // On a coarse lattice differences tell where the force is, not how noisy it is.
  if (study.is_static() || study.rounding_step > 0.0) return levels;
  const std::vector<Span> resting = rests(study);
  for (Index j = 0; j < study.channel_count(); ++j) {
    if (!steps_hide_noise(study, j)) level_of(study, residual, force, j, resting, levels);
  }
  return levels;
}

}  // namespace dcnn
