// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/spectral_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/elementary.h"
#include "data/bridge.h"
#include "data/median.h"
#include "dcnn/data/fourier.h"

namespace dcnn {

Eigen::VectorXd hann_power(const Eigen::VectorXd& x, Index length) {
  const Index n = x.size();
  const Eigen::ArrayXd phase = Eigen::ArrayXd::LinSpaced(n, 0.5, static_cast<double>(n) - 0.5) *
                               2.0 * std::numbers::pi / double(n);
  Eigen::VectorXd tapered = Eigen::VectorXd::Zero(length);
  tapered.head(n) = (x.array() - x.mean()) * (1.0 - elementary::cos(phase));
  return fourier(tapered).cwiseAbs2() / (1.5 * static_cast<double>(n));
}

namespace {

constexpr Index kFewestBeside = 12;  // bins, on each side
constexpr double kBesideHz = 3.0;  // on each side: so many bins that the level is known to a tenth

/// A segment on the even grid of its clock, less its mean: 0 where the log lost a row.
Eigen::VectorXd evenly(const Motion& motion, const Segment& s, const Eigen::VectorXd& signal) {
  const std::vector<Index> places = clock_places(motion.t, s, motion.dt);
  const double mean = signal.segment(s.begin, s.size()).mean();
  Eigen::VectorXd even = Eigen::VectorXd::Zero(places.back() + 1);
  for (Index i = 0; i < s.size(); ++i) {
    even(places[static_cast<std::size_t>(i)]) = signal(s.begin + i) - mean;
  }
  return even;
}

/// A channel's segments, evenly, that are at least half as long as the longest of all: shorter ones
/// tell a frequency less exactly.
std::vector<Eigen::VectorXd> pieces_of(const Case& study, const Signals& signals, Index channel) {
  Index longest = 0;
  for (const Log& log : study.logs) {
    for (const Segment& s : log.motion.segments) longest = std::max(longest, s.size());
  }
  std::vector<Eigen::VectorXd> pieces;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const Motion& motion = study.logs[k].motion;
    for (const Segment& s : motion.segments) {
      if (2 * s.size() < longest) continue;
      pieces.push_back(evenly(motion, s, signals[k].col(channel)));
    }
  }
  return pieces;
}

/// A length at which all of them are transformed.
Index length_of(const std::vector<Eigen::VectorXd>& pieces) {
  Index longest = 0;
  for (const Eigen::VectorXd& piece : pieces) longest = std::max(longest, piece.size());
  return fast_length(longest);
}

/// The mean level beside bin k of a sum of so many independent periodograms, from its median; on
/// the louder side, where the sides differ by more than chance: noise that a filter of the pose
/// passes ends at once. None of a spectrum with nothing beside it.
std::optional<double> level_beside(const Eigen::VectorXd& power, Index k, Index around,
                                   double terms) {
  constexpr Index kOfLine = 3;           // bins of a line on either side
  constexpr double kBeyondChance = 4.0;  // deviations of the difference of two medians
  const auto bins = [&](Index from, Index end) {
    const Index first = std::max<Index>(1, from), last = std::min(power.size(), end);
    return last > first ? std::vector<double>(power.begin() + first, power.begin() + last)
                        : std::vector<double>();
  };
  const std::vector<double> below = bins(k - around, k - kOfLine),
                            above = bins(k + kOfLine + 1, k + around);
  std::vector<double> both = below;
  both.insert(both.end(), above.begin(), above.end());
  if (both.empty()) return std::nullopt;
  double level = dcnn::median(both);
  if (!below.empty() && !above.empty()) {
    // A median of n such sums has the relative deviation 1.25/sqrt(n terms).
    const double chance =
        1.25 * std::sqrt((1.0 / double(below.size()) + 1.0 / double(above.size())) / terms);
    const double a = dcnn::median(below), b = dcnn::median(above);
    if (std::abs(a - b) > kBeyondChance * chance * level) level = std::max(a, b);
  }
  // Of an exponential distribution, and nearly of a gamma distribution.
  const double median = terms == 1.0 ? elementary::log(2.0) : 1.0 - 1.0 / (3.0 * terms);
  return level / median;
}

/// Of how many independent periodograms those of all channels are the sum. Noise that channels
/// share makes them fewer: the squares of two Fourier coefficients of correlation r have
/// correlation r^2, and r is that of the second differences, which hold little else than noise.
double independent_channels(const Case& study, const Signals& left) {
  const Index channels = left.front().cols();
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(channels, channels);
  for (std::size_t k = 0; k < left.size(); ++k) {
    for (const Segment& s : study.logs[k].motion.segments) {
      const Index n = s.size() - 2;
      if (n < 1) continue;
      const Eigen::MatrixXd x = left[k].middleRows(s.begin, s.size());
      const Eigen::MatrixXd d = x.topRows(n) - 2.0 * x.middleRows(1, n) + x.bottomRows(n);
      gram += d.transpose() * d;
    }
  }
  double sum = 0.0;
  for (Index i = 0; i < channels; ++i) {
    for (Index j = 0; j < channels; ++j) {
      const double scale = gram(i, i) * gram(j, j);
      sum += i == j ? 1.0 : scale > 0.0 ? gram(i, j) * gram(i, j) / scale : 0.0;
    }
  }
  return static_cast<double>(channels * channels) / sum;
}

/// The bins of local maxima between two frequencies, the greatest first, none near a greater one.
std::vector<Index> maxima(const Eigen::VectorXd& power, const Eigen::VectorXd& relative,
                          double bin_hz, double from_hz, double to_hz, int most) {
  std::vector<Index> bins;
  for (Index k = 2; k + 2 < power.size(); ++k) {
    const double hz = static_cast<double>(k) * bin_hz;
    if (hz < from_hz || hz > to_hz || power(k) < power(k - 1) || power(k) < power(k + 1)) continue;
    bins.push_back(k);
  }
  std::sort(bins.begin(), bins.end(), [&](Index a, Index b) { return relative(a) > relative(b); });
  std::vector<Index> apart;
  for (const Index k : bins) {
    const bool near = std::any_of(apart.begin(), apart.end(), [&](Index other) {
      const double hz = static_cast<double>(k) * bin_hz;
      return std::abs(static_cast<double>(other - k)) * bin_hz < std::max(0.1, 0.04 * hz);
    });
    if (!near) apart.push_back(k);
    if (static_cast<int>(apart.size()) == most) break;
  }
  return apart;
}

Eigen::VectorXd densities(const Floor& floor, Index bins, double bin_hz) {
  Eigen::VectorXd density(bins);
  for (Index k = 0; k < bins; ++k) {
    density(k) = std::max(1e-300, floor.density(static_cast<double>(k) * bin_hz));
  }
  return density;
}

}  // namespace

std::vector<Peak> spectral_lines(const Case& study, const Signals& left,
                                 const std::vector<Floor>& floors, double from_hz, double to_hz,
                                 Index channel, int most) {
  const auto pieces = pieces_of(study, left, channel);
  // The longest tells frequencies best.
  const auto longest =
      std::max_element(pieces.begin(), pieces.end(),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  const Index length = length_of(pieces);
  const double bin_hz = 1.0 / (static_cast<double>(length) * study.dt());
  const Eigen::VectorXd power = hann_power(*longest, length);
  const Eigen::VectorXd ratio = power.cwiseQuotient(
      densities(floors[static_cast<std::size_t>(channel)], power.size(), bin_hz));
  std::vector<Peak> peaks;
  for (const Index k : maxima(power, ratio, bin_hz, from_hz, to_hz, most)) {
    peaks.push_back({static_cast<double>(k) * bin_hz, ratio(k)});
  }
  return peaks;
}

bool CommonLine::stands_out() const { return excess > 13.5 + 5.0 * std::sqrt(terms); }

std::vector<CommonLine> common_lines(const Case& study, const Signals& left,
                                     const std::vector<Floor>& floors, double from_hz, double to_hz,
                                     int most) {
  std::vector<std::vector<Eigen::VectorXd>> channels;
  for (Index j = 0; j < study.channel_count(); ++j) channels.push_back(pieces_of(study, left, j));
  const Index length = length_of(channels.front());
  const double bin_hz = 1.0 / (static_cast<double>(length) * study.dt());
  const auto around = std::max(kFewestBeside, static_cast<Index>(kBesideHz / bin_hz));
  const double terms =
      independent_channels(study, left) * static_cast<double>(channels.front().size());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(length / 2 + 1);
  for (std::size_t j = 0; j < channels.size(); ++j) {
    const Eigen::VectorXd density = densities(floors[j], sum.size(), bin_hz);
    for (const Eigen::VectorXd& piece : channels[j]) {
      sum += hann_power(piece, length).cwiseQuotient(density);
    }
  }
  std::vector<CommonLine> lines;
  for (const Index k : maxima(sum, sum, bin_hz, from_hz, to_hz, most)) {
    const auto level = level_beside(sum, k, around, terms);
    if (!level) continue;
    const double excess = (sum(k) / std::max(1e-300, *level) - 1.0) * terms;
    const auto count = static_cast<double>(channels.size() * channels.front().size());
    lines.push_back({static_cast<double>(k) * bin_hz, sum(k), excess, terms, *level / count});
  }
  return lines;
}

}  // namespace dcnn
