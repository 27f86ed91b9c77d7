// SPDX-License-Identifier: Apache-2.0
#include "import/clock_signals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace dcnn {
namespace {

using Vector3 = Eigen::Vector3d;

// |H|^2 = exp(-(2 pi f s)^2) is a half at f = sqrt(ln 2)/(2 pi s).
constexpr double kHalfPower = 0.1325;
constexpr double kWider = 3.0;     // of the first Gaussian's band
constexpr double kReach = 3.0;     // standard deviations that a Gaussian is summed over
constexpr double kNearest = 1.5;   // of the first Gaussian's: a sample must be as near on each side
constexpr double kSlowPart = 0.1;  // of the speed's rms: below it friction turns linearly

/// Central differences; one-sided at the ends.
Eigen::MatrixXd differences(const Eigen::MatrixXd& x, double step) {
  const Index rows = x.rows();
  Eigen::MatrixXd d(rows, x.cols());
  for (Index k = 0; k < rows; ++k) {
    const Index before = std::max<Index>(0, k - 1), after = std::min(rows - 1, k + 1);
    d.row(k) = (x.row(after) - x.row(before)) / (step * static_cast<double>(after - before));
  }
  return d;
}

Eigen::Quaterniond turn_in(const Eigen::MatrixXd& pose, Index row) {
  return Eigen::Quaterniond(pose(row, 3), pose(row, 4), pose(row, 5), pose(row, 6)).normalized();
}

/// w in the body's frame: 2 q* dq/dt.
Eigen::MatrixXd body_rates(const Eigen::MatrixXd& pose, const Eigen::MatrixXd& slope) {
  Eigen::MatrixXd w(pose.rows(), 3);
  for (Index k = 0; k < pose.rows(); ++k) {
    const Eigen::Quaterniond dq(slope(k, 3), slope(k, 4), slope(k, 5), slope(k, 6));
    w.row(k) = 2.0 * (turn_in(pose, k).conjugate() * dq).vec().transpose();
  }
  return w;
}

/// Whole rows whose neighbours within `reach` are whole.
std::vector<char> shrunk(const std::vector<char>& whole, Index reach) {
  const auto rows = std::ssize(whole);
  std::vector<char> kept(whole.size(), 1);
  for (Index k = 0; k < rows; ++k) {
    if (whole[static_cast<std::size_t>(k)] != 0 && k > 0 && k + 1 < rows) continue;
    const Index begin = std::max<Index>(0, k - reach), end = std::min<Index>(rows, k + reach + 1);
    std::fill(kept.begin() + begin, kept.begin() + end, 0);
  }
  return kept;
}

}  // namespace

bool EvenSignals::at(double time, Eigen::VectorXd* out) const {
  const double place = (time - begin) / step;
  const Index k = static_cast<Index>(std::floor(place));
  if (k < 1 || k + 2 >= values.rows()) return false;
  for (Index n = k - 1; n <= k + 2; ++n) {
    if (whole[static_cast<std::size_t>(n)] == 0) return false;
  }
  const double p = place - static_cast<double>(k);
  *out = (-p * (p - 1.0) * (p - 2.0) / 6.0 * values.row(k - 1) +
          (p + 1.0) * (p - 1.0) * (p - 2.0) / 2.0 * values.row(k) -
          (p + 1.0) * p * (p - 2.0) / 2.0 * values.row(k + 1) +
          (p + 1.0) * p * (p - 1.0) / 6.0 * values.row(k + 2))
             .transpose();
  return true;
}

BandFilter::BandFilter(double hz) : first_(kHalfPower / (kWider * hz)), second_(kHalfPower / hz) {}

double BandFilter::independent() const {
  return 1.0 / (2.0 * std::sqrt(std::numbers::pi) * std::hypot(first_, second_));
}

/// Local lines with Gaussian weights, at steps of half of their standard deviation.
EvenSignals BandFilter::sampled(const std::vector<double>& t, const Eigen::MatrixXd& values) const {
  EvenSignals out;
  out.begin = t.front();
  out.step = 0.5 * first_;
  const auto rows = static_cast<Index>((t.back() - t.front()) / out.step) + 1;
  out.values = Eigen::MatrixXd::Zero(rows, values.cols());
  out.whole.assign(static_cast<std::size_t>(rows), 0);
  std::size_t begin = 0;
  for (Index row = 0; row < rows; ++row) {
    const double centre = out.begin + out.step * static_cast<double>(row);
    while (begin < t.size() && t[begin] < centre - kReach * first_) ++begin;
    double s0 = 0.0, s1 = 0.0, s2 = 0.0, before = kReach * first_, after = kReach * first_;
    Eigen::RowVectorXd y0 = Eigen::RowVectorXd::Zero(values.cols()), y1 = y0;
    for (std::size_t k = begin; k < t.size() && t[k] <= centre + kReach * first_; ++k) {
      const double d = t[k] - centre, part = d / first_;
      const double weight = elementary::exp(-0.5 * part * part);
      s0 += weight, s1 += weight * d, s2 += weight * d * d;
      y0 += weight * values.row(static_cast<Index>(k));
      y1 += weight * d * values.row(static_cast<Index>(k));
      (d <= 0.0 ? before : after) = std::min(d <= 0.0 ? before : after, std::abs(d));
      if (d == 0.0) after = 0.0;
    }
    const double spread = s0 * s2 - s1 * s1;
    if (!(spread > 0.0) || std::max(before, after) > kNearest * first_) continue;
    out.values.row(row) = (s2 * y0 - s1 * y1) / spread;
    out.whole[static_cast<std::size_t>(row)] = 1;
  }
  return out;
}

EvenSignals BandFilter::smoothed(const EvenSignals& from) const {
  const auto reach = static_cast<Index>(std::ceil(kReach * second_ / from.step));
  Eigen::VectorXd weights(2 * reach + 1);
  for (Index k = -reach; k <= reach; ++k) {
    const double part = static_cast<double>(k) * from.step / second_;
    weights[k + reach] = elementary::exp(-0.5 * part * part);
  }
  weights /= weights.sum();
  EvenSignals out = from;
  out.whole = shrunk(from.whole, reach);
  for (Index row = 0; row < from.values.rows(); ++row) {
    if (out.whole[static_cast<std::size_t>(row)] == 0) continue;
    out.values.row(row) = weights.transpose() * from.values.middleRows(row - reach, 2 * reach + 1);
  }
  return out;
}

EvenSignals BandFilter::force(const std::vector<double>& t, const Eigen::MatrixXd& force) const {
  return smoothed(sampled(t, force));
}

EvenSignals BandFilter::pose(const std::vector<double>& t, const Eigen::MatrixXd& pose) const {
  EvenSignals signals = sampled(t, pose);
  const Eigen::MatrixXd samples = signals.values;
  const double h = signals.step;
  const Eigen::MatrixXd slope = differences(samples, h);
  Eigen::MatrixXd bend = Eigen::MatrixXd::Zero(samples.rows(), 3);
  for (Index k = 1; k + 1 < samples.rows(); ++k) {
    bend.row(k) =
        (samples.row(k + 1) - 2.0 * samples.row(k) + samples.row(k - 1)).head(3) / (h * h);
  }
  const Eigen::MatrixXd w = body_rates(samples, slope), dw = differences(w, h);
  signals.whole = shrunk(signals.whole, 2);
  double square = 0.0, count = 0.0;
  for (Index k = 0; k < samples.rows(); ++k) {
    if (signals.whole[static_cast<std::size_t>(k)] == 0) continue;
    square += slope.row(k).head(3).squaredNorm();
    count += 1.0;
  }
  const double slow = kSlowPart * std::sqrt(square / std::max(1.0, count)) + 1e-12;
  signals.values.resize(samples.rows(), 22);
  for (Index k = 0; k < samples.rows(); ++k) {
    const Eigen::Matrix3d to_body = turn_in(samples, k).toRotationMatrix().transpose();
    const Vector3 v = to_body * slope.row(k).head(3).transpose();
    const Vector3 rate = w.row(k).transpose();
    signals.values.row(k) << to_body.col(2).transpose(),
        (to_body * bend.row(k).transpose()).transpose(), dw.row(k), rate.cwiseAbs2().transpose(),
        rate.x() * rate.y(), rate.y() * rate.z(), rate.z() * rate.x(), v.transpose(),
        v.transpose() / std::hypot(v.norm(), slow), 1.0;
  }
  return smoothed(signals);
}

}  // namespace dcnn
