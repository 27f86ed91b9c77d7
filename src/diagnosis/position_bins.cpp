// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/position_bins.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/elementary.h"
#include "core/linear_algebra.h"
#include "data/median.h"
#include "dcnn/data/fourier.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/periodograms.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr double kPositionBins = 1000.0, kMostBins = 200'000.0;  // of an axis
constexpr double kLargestPhase = 0.5;  // rad, of an order, from one bin to the next
constexpr double kOrderStep = 0.4;     // rad, of the phase over the whole range, between orders
constexpr double kFewTurns = 8.0;  // over the range, up to which a straight line resembles a wave

Eigen::VectorXd padded(const Eigen::VectorXd& x, Index n) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(n);
  y.head(x.size()) = x;
  return y;
}

/// What a sine and a cosine of this order explain beside a straight line in the position.
double order_gain(const PositionBins& bins, double order) {
  Eigen::Matrix4d gram = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  const double first = 0.5 * (bins.width - bins.range());
  std::complex<double> wave = elementary::polar(1.0, order * first);
  const std::complex<double> turn = elementary::polar(1.0, order * bins.width);
  for (Index k = 0; k < bins.size(); ++k, wave *= turn) {
    if (bins.count(k) == 0.0) continue;
    const Eigen::Vector4d row(1.0, first + bins.width * static_cast<double>(k), wave.imag(),
                              wave.real());
    gram += bins.count(k) * row * row.transpose();
    b += bins.sum(k) * row;
  }
  gram.diagonal().array() += 1e-9 * gram.diagonal().maxCoeff();
  return b.dot(solve_symmetric(gram, b).col(0));
}

/// The bins' sums without the straight line that fits them best.
Eigen::VectorXd without_line(const PositionBins& bins) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(bins.size(), -1.0, 1.0);
  Eigen::Matrix2d gram;
  gram << bins.count.sum(), bins.count.dot(x), bins.count.dot(x), bins.count.dot(x.cwiseAbs2());
  gram.diagonal().array() += 1e-9 * gram.diagonal().maxCoeff();
  const Eigen::VectorXd line =
      solve_symmetric(gram, Eigen::Vector2d(bins.sum.sum(), bins.sum.dot(x))).col(0);
  return bins.sum.array() - bins.count.array() * (line(0) + line(1) * x.array());
}

/// Of orders k·step: what a sine and a cosine explain of that (Lomb and Scargle).
struct OrderSpectrum {
  double step;
  Eigen::VectorXd gain;
};
OrderSpectrum order_spectrum(const PositionBins& bins) {
  const auto size = static_cast<double>(bins.size());
  const Index n = fast_length(std::llround(2.0 * std::numbers::pi / kOrderStep * size));
  const Fourier transform(n);
  const Eigen::VectorXcd b = transform(padded(without_line(bins), n));
  const Eigen::VectorXcd weight = transform(padded(bins.count, n));
  const double whole = bins.count.sum();
  Eigen::VectorXd gain = Eigen::VectorXd::Zero(n / 4);
  for (Index k = 1; k < gain.size(); ++k) {
    // Sums of cos^2, sin^2 and their product are of twice the order.
    const std::complex<double> twice = weight(2 * k);
    const double cc = 0.5 * (whole + twice.real()), ss = 0.5 * (whole - twice.real());
    const double cs = -0.5 * twice.imag(), c = b(k).real(), s = -b(k).imag();
    const double determinant = cc * ss - cs * cs;
    if (determinant > 1e-9 * whole * whole) {
      gain(k) = (c * c * ss - 2.0 * c * s * cs + s * s * cc) / determinant;
    }
  }
  return {2.0 * std::numbers::pi / (bins.width * static_cast<double>(n)), std::move(gain)};
}

}  // namespace

PositionBins::PositionBins(double from, double to, double bin)
    : low(from), width(std::max(bin, kTiny)) {
  const Index n = static_cast<Index>((to - from) / width) + 1;
  sum = count = Eigen::VectorXd::Zero(n);
}

void PositionBins::add(double position, double value, double square) {
  const auto bin = static_cast<Index>((position - low) / width);
  sum(bin) += value;
  count(bin) += square;
}

double best_order(const PositionBins& bins, double least, double highest) {
  constexpr int kTried = 5;
  double best = 0.0, most = -1.0;
  const auto look_at = [&](double order) {
    const double gain = order_gain(bins, order);
    if (gain > most) most = gain, best = order;
  };
  const double few = kFewTurns * 2.0 * std::numbers::pi / bins.range();
  for (double order = least; order < std::min(few, highest); order += kOrderStep / bins.range()) {
    look_at(order);
  }
  if (highest <= few) return best;
  auto [step, spectrum] = order_spectrum(bins);
  for (Index k = 0; k < spectrum.size(); ++k) {
    const double order = step * static_cast<double>(k);
    if (order < std::max(least, few) || order >= highest) spectrum(k) = 0.0;
  }
  for (int tried = 0; tried < kTried; ++tried) {
    Index peak;
    if (!(spectrum.maxCoeff(&peak) > 0.0)) break;
    look_at(step * static_cast<double>(peak));
    const Index near = std::llround(2.0 * std::numbers::pi / kOrderStep);  // of the same line
    const Index from = std::max<Index>(0, peak - near);
    spectrum.segment(from, std::min(spectrum.size(), peak + near + 1) - from).setZero();
  }
  return best;
}

double position_bin(const Case& study) {
  double low = 1e300, high = -1e300, square = 0.0, rows = 0.0;
  for (const Log& log : study.logs) {
    low = std::min(low, log.motion.euler.col(0).minCoeff());
    high = std::max(high, log.motion.euler.col(0).maxCoeff());
    if (log.motion.v_B.rows() > 0) square += log.motion.v_B.col(0).squaredNorm();
    rows += static_cast<double>(log.motion.samples());
  }
  const double range = high - low, speed = std::sqrt(square / rows);
  const double order = speed > 0.0 ? 2.0 * std::numbers::pi * study.shown_hz() / speed : 0.0;
  return range / std::clamp(order * range / kLargestPhase, kPositionBins, kMostBins);
}

double least_order(const Case& study, int angle, double periods) {
  double range = 0.0;
  for (const Log& log : study.logs) {
    const auto q = log.motion.euler.col(angle);
    range = std::max(range, q.maxCoeff() - q.minCoeff());
  }
  return periods * 2.0 * std::numbers::pi / range;
}

double highest_order(const Case& study, const ShapeParameter& order, double width) {
  const double told = kLargestPhase / width;
  return study.axis ? told : std::min(order.high, told);
}

double band_of_position_lines(const std::vector<Eigen::VectorXd>& forces,
                              const std::vector<Eigen::VectorXd>& positions, double dt,
                              double band_hz) {
  constexpr double kChance = 0.001;                // of the loudest of all orders of noise
  constexpr double kMargin = 1.3, kHighest = 0.2;  // of a line; of the sample rate
  if (!(dt > 0.0)) return 0.0;
  const auto window = std::max<Index>(1, std::llround(0.5 / band_hz / dt));
  double low = 1e300, high = -1e300, square = 0.0, rows = 0.0, whole = 0.0;
  for (const Eigen::VectorXd& q : positions) {
    low = std::min(low, q.minCoeff()), high = std::max(high, q.maxCoeff());
    const Index pairs = std::max<Index>(0, q.size() - window);  // so far apart that noise is small
    const double seconds = double(window) * dt;
    square += (q.tail(pairs) - q.head(pairs)).squaredNorm() / (seconds * seconds);
    rows += static_cast<double>(pairs);
  }
  const double speed = std::sqrt(square / std::max(1.0, rows)), range = high - low;
  if (!(speed > 0.0)) return 0.0;
  const double top = 2.0 * std::numbers::pi * kHighest / dt / speed;  // order
  PositionBins bins(low, high, range / std::clamp(top * range / kLargestPhase, 16.0, kMostBins));
  for (std::size_t k = 0; k < forces.size(); ++k) {
    // Less its mean over half a period of the band's end to either side.
    const Eigen::VectorXd slow = moving_mean(forces[k], {{0, forces[k].size()}}, window);
    for (Index i = window; i + window < forces[k].size(); ++i) {
      const double fast = forces[k](i) - slow(i);
      bins.add(positions[k](i), fast, 1.0);
      whole += fast * fast;
    }
  }
  if (whole == 0.0) return 0.0;
  const auto [step, spectrum] = order_spectrum(bins);
  const auto begin = static_cast<Index>(2.0 * std::numbers::pi * band_hz / speed / step) + 1;
  const Index end = std::min(spectrum.size(), static_cast<Index>(top / step));
  if (end <= begin) return 0.0;
  const auto orders = spectrum.segment(begin, end - begin);
  // The median of an exponential variable is ln 2 of its mean.
  const double noise = median({orders.data(), orders.data() + orders.size()}) / std::numbers::ln2;
  const double loud = noise * elementary::log(double(orders.size()) / kChance);
  Index last = -1;
  for (Index k = 0; k < orders.size(); ++k) {
    if (orders(k) > loud && orders(k) > prior::kLeastPositionLine * whole) last = k;
  }
  if (last < 0) return 0.0;
  const double hz = step * static_cast<double>(begin + last) * speed / (2.0 * std::numbers::pi);
  return std::min(kMargin * hz, kHighest / dt);
}

}  // namespace dcnn
