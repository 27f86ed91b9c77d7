// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/periodograms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "data/median.h"
#include "dcnn/data/fourier.h"
#include "diagnosis/noise_floor.h"
#include "diagnosis/rest.h"
#include "diagnosis/spectral_lines.h"

namespace dcnn {
namespace {

constexpr Index kWindow = 1024;  // samples of one periodogram
constexpr Index kShortestWindow = 64;

/// Samples of a window of which segments long enough hold half of the recordings.
Index window_of(const Case& study) {
  Index longest = 0;
  for (Index n = kWindow; n >= kShortestWindow; n /= 2) {
    Index all = 0, held = 0;
    for (std::size_t k = 0; k < study.logs.size(); ++k) {
      for (const Segment& s : study.logs[k].motion.segments) {
        all += s.size();
        if (s.size() >= n) held += s.size();
        longest = std::max(longest, s.size());
      }
    }
    if (2 * held >= all) return n;
  }
  return std::max<Index>(16, std::min(longest, kShortestWindow));
}

}  // namespace

Periodograms periodograms(const Case& study, const Signals& signals, Index channel) {
  const Index n = window_of(study);
  const Eigen::ArrayXd phase = Eigen::ArrayXd::LinSpaced(n, 0.5, static_cast<double>(n) - 0.5) *
                               2.0 * std::numbers::pi / static_cast<double>(n);
  const Eigen::VectorXd taper = (1.0 - elementary::cos(phase)).matrix() * 0.5;
  const double power = taper.squaredNorm();
  Periodograms result;
  const Index bins = n / 2 + 1;
  result.hz = Eigen::VectorXd::LinSpaced(bins, 0.0, static_cast<double>(bins - 1)) /
              (static_cast<double>(n) * study.dt());
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    for (const Segment& s : study.logs[k].motion.segments) {
      for (Index begin = s.begin; begin + n <= s.end; begin += n) {
        Eigen::VectorXd x = signals[k].col(channel).segment(begin, n);
        x.array() -= x.mean();
        columns.push_back(fourier(x.cwiseProduct(taper)).cwiseAbs2() / power);
      }
    }
  }
  result.power.resize(bins, static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    result.power.col(static_cast<Index>(k)) = columns[k];
  }
  return result;
}

Eigen::MatrixXd moving_mean(const Eigen::MatrixXd& x, const std::vector<Segment>& segments,
                            Index half) {
  Eigen::MatrixXd mean = x;
  for (const Segment& s : segments) {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(x.cols());
    Index from = s.begin, to = s.begin;
    for (Index i = s.begin; i < s.end; ++i) {
      while (to < std::min(s.end, i + half + 1)) sum += x.row(to++);
      while (from < i - half) sum -= x.row(from++);
      mean.row(i) = sum / static_cast<double>(to - from);
    }
  }
  return mean;
}

Signals evened(const Case& study, const Signals& residual, const Signals& levels) {
  const std::vector<Span> resting = rests(study);
  const auto half = static_cast<Index>(std::llround(0.5 / quiet_band(study) / study.dt()));
  const Index wide = window_of(study) / 4;  // two means of half a window
  Signals even;
  for (std::size_t k = 0; k < residual.size(); ++k) {
    const Motion& motion = study.logs[k].motion;
    Eigen::MatrixXd square = levels[k].cwiseAbs2();
    for (const Span& span : resting) {
      if (span.log != k) continue;
      const auto [from, to] = rows_of(motion, span);
      square.middleRows(from, to - from).setOnes();
    }
    const auto smooth = [&](const Eigen::MatrixXd& x, Index width) {
      return moving_mean(moving_mean(x, motion.segments, width), motion.segments, width);
    };
    // Means weighted by 1/L^2: of a loud stretch nothing leaks into a quiet one beside it.
    const Eigen::MatrixXd weight = levels[k].cwiseAbs2().cwiseInverse();
    const Eigen::MatrixXd weights = smooth(weight, half);
    const auto local_mean = [&](const Eigen::MatrixXd& x) {
      return Eigen::MatrixXd(smooth(x.cwiseProduct(weight), half).cwiseQuotient(weights));
    };
    Eigen::MatrixXd slow = smooth(residual[k], half);
    slow += smooth(residual[k] - slow, half);  // twicing (Tukey 1977): loses 1 - H as its square
    for (int pass = 0; pass < 3; ++pass) slow += local_mean(residual[k] - slow);
    even.push_back((residual[k] - slow).cwiseQuotient(levels[k]) +
                   slow.cwiseQuotient(smooth(square, wide).cwiseSqrt()));
  }
  return even;
}

std::vector<SlowBin> slow_bins(const Case& study, const Signals& signals, Index channel) {
  constexpr Index kMeans = 16;  // a window, whose third bin they hardly damp (0.98)
  const Index window = window_of(study), block = std::max<Index>(1, window / kMeans);
  const double to = 2.0 / (static_cast<double>(window) * study.dt());
  std::vector<SlowBin> bins;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    for (const Segment& s : study.logs[k].motion.segments) {
      const Index n = s.size() / block;
      if (n < 2 * kMeans) continue;
      Eigen::VectorXd means(n);
      for (Index i = 0; i < n; ++i) {
        means(i) = signals[k].col(channel).segment(s.begin + i * block, block).mean();
      }
      const Eigen::VectorXd power = static_cast<double>(block) * hann_power(means, n);
      const double step = 1.0 / (static_cast<double>(n * block) * study.dt());
      // The taper takes the mean off the two lowest bins.
      for (Index i = 2; i < power.size() && static_cast<double>(i) * step < to; ++i) {
        bins.push_back({static_cast<double>(i) * step, power(i)});
      }
    }
  }
  return bins;
}

Eigen::VectorXd density_of(const Periodograms& p, bool uneven) {
  if (uneven && p.power.cols() > 0) return p.power.rowwise().mean();
  Eigen::VectorXd density(p.power.rows());
  double expected = 0.0;
  for (Index i = 0; p.power.cols() > 0 && i <= p.power.cols() / 2; ++i)
    expected += 1.0 / double(p.power.cols() - i);
  for (Index i = 0; i < density.size(); ++i) {
    std::vector<double> values(static_cast<std::size_t>(p.power.cols()));
    for (Index k = 0; k < p.power.cols(); ++k) values[static_cast<std::size_t>(k)] = p.power(i, k);
    density(i) = values.empty() ? 0.0 : median(values) / expected;
  }
  return density;
}

}  // namespace dcnn
