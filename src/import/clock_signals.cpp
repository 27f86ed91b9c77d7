// SPDX-License-Identifier: Apache-2.0
#include "import/clock_signals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

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

constexpr double kStride = 0.5;          // standard deviations between rows
constexpr std::size_t kRowsAtOnce = 16;  // above 2 kReach / kStride + 1, which one sample reaches

/// The numbers of one sample, a pose's seven at most; zeros behind them.
using SampleNumbers = Eigen::Matrix<double, 1, 8>;

/// Sums of a line's least squares around one time, and how near the samples are on both sides.
class LineSums {
 public:
  explicit LineSums(double farthest) : farthest_(farthest) { clear(); }

  void clear() {
    s0_ = s1_ = s2_ = 0.0;
    before_ = after_ = farthest_;
    y0_.setZero();
    y1_.setZero();
  }
  /// A sample `d` s after the row's time.
  void add(double d, double weight, const SampleNumbers& y) {
    const double first = weight * d;
    s0_ += weight, s1_ += first, s2_ += first * d;
    y0_ += weight * y;
    y1_ += first * y;
    (d <= 0.0 ? before_ : after_) = std::min(d <= 0.0 ? before_ : after_, std::abs(d));
    if (d == 0.0) after_ = 0.0;
  }
  /// The line's value at the row's time; false with too few samples, or none as near as `nearest`.
  bool solve(double nearest, Eigen::Ref<Eigen::RowVectorXd> out) const {
    const double spread = s0_ * s2_ - s1_ * s1_;
    if (!(spread > 0.0) || std::max(before_, after_) > nearest) return false;
    out = ((s2_ * y0_ - s1_ * y1_) / spread).head(out.size());
    return true;
  }

 private:
  double farthest_, s0_ = 0.0, s1_ = 0.0, s2_ = 0.0, before_ = 0.0, after_ = 0.0;
  SampleNumbers y0_, y1_;
};

/// Fits the lines of all rows while it goes through the samples once. A sample f standard
/// deviations from its nearest row has in the j-th row from there the weight exp(-(f - kStride j)^2
/// / 2) = exp(-f^2 / 2) exp(kStride f)^j exp(-(kStride j)^2 / 2): two exponentials a sample.
class LocalLines {
 public:
  LocalLines(double sd, EvenSignals* out)
      : sd_(sd), out_(*out), sums_(kRowsAtOnce, LineSums(kReach * sd)) {
    for (std::size_t j = 0; j < kRowsAtOnce; ++j) {
      of_rows_[j] = elementary::exp(-0.5 * kStride * kStride * static_cast<double>(j * j));
    }
  }

  /// Samples in the order of their times.
  void add(double t, const Eigen::Ref<const Eigen::RowVectorXd, 0, Eigen::InnerStride<>>& y) {
    constexpr double kRows = kReach / kStride, kRounding = 1e-6;
    const double place = (t - out_.begin) / out_.step;
    const auto low = static_cast<Index>(std::ceil(place - kRows - kRounding));
    const auto high = static_cast<Index>(std::floor(place + kRows + kRounding));
    const auto nearest = static_cast<Index>(std::floor(place + 0.5));
    close_until(std::min(low, out_.values.rows()));
    y_.head(y.size()) = y;
    const double f = kStride * (place - static_cast<double>(nearest));
    const double here = elementary::exp(-0.5 * f * f), next = elementary::exp(kStride * f);
    double power = here;
    for (Index row = nearest; row <= high; ++row, power *= next) {
      add_to(row, t, power * of_rows_[static_cast<std::size_t>(row - nearest)]);
    }
    const double back = 1.0 / next;
    power = here * back;
    for (Index row = nearest - 1; row >= low; --row, power *= back) {
      add_to(row, t, power * of_rows_[static_cast<std::size_t>(nearest - row)]);
    }
  }
  void finish() { close_until(out_.values.rows()); }

 private:
  LineSums& sums_of_row(Index row) { return sums_[static_cast<std::size_t>(row) % kRowsAtOnce]; }

  void add_to(Index row, double t, double weight) {
    if (row < 0 || row >= out_.values.rows()) return;
    const double d = t - (out_.begin + out_.step * static_cast<double>(row));
    if (std::abs(d) <= kReach * sd_) sums_of_row(row).add(d, weight, y_);
  }

  /// No later sample reaches the rows before `end`.
  void close_until(Index end) {
    for (; open_ < end; ++open_) {
      LineSums& sums = sums_of_row(open_);
      const bool whole = sums.solve(kNearest * sd_, out_.values.row(open_));
      out_.whole[static_cast<std::size_t>(open_)] = whole ? 1 : 0;
      sums.clear();
    }
  }

  double sd_;  // s
  EvenSignals& out_;
  SampleNumbers y_ = SampleNumbers::Zero();
  std::vector<LineSums> sums_;  // of row k at k % kRowsAtOnce
  std::array<double, kRowsAtOnce> of_rows_{};
  Index open_ = 0;  // the first row that is not done
};

/// The slope of the first N signals at a row: central difference, one-sided at the ends.
template <int N>
Eigen::Matrix<double, 1, N> slope_at(const SignalRows& x, Index row, double step) {
  const Index before = std::max<Index>(0, row - 1), after = std::min(x.rows() - 1, row + 1);
  return (x.row(after).head<N>() - x.row(before).head<N>()) /
         (step * static_cast<double>(after - before));
}

/// The second derivative of the position at a row; zero at the ends.
Vector3 bend_at(const SignalRows& x, Index row, double step) {
  if (row == 0 || row + 1 == x.rows()) return Vector3::Zero();
  return (x.row(row + 1) - 2.0 * x.row(row) + x.row(row - 1)).head<3>().transpose() / (step * step);
}

Eigen::Quaterniond turn_in(const SignalRows& pose, Index row) {
  return Eigen::Quaterniond(pose(row, 3), pose(row, 4), pose(row, 5), pose(row, 6)).normalized();
}

/// w in the body's frame: 2 q* dq/dt.
SignalRows body_rates(const SignalRows& pose, double step) {
  SignalRows w(pose.rows(), 3);
  for (Index k = 0; k < pose.rows(); ++k) {
    const Eigen::Matrix<double, 1, 7> slope = slope_at<7>(pose, k, step);
    const Eigen::Quaterniond dq(slope[3], slope[4], slope[5], slope[6]);
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

bool EvenSignals::at(double time, Eigen::Ref<Eigen::RowVectorXd> out) const {
  const double place = (time - begin) / step;
  const Index k = static_cast<Index>(std::floor(place));
  if (k < 1 || k + 2 >= values.rows()) return false;
  for (Index n = k - 1; n <= k + 2; ++n) {
    if (whole[static_cast<std::size_t>(n)] == 0) return false;
  }
  const double p = place - static_cast<double>(k);
  out = -p * (p - 1.0) * (p - 2.0) / 6.0 * values.row(k - 1) +
        (p + 1.0) * (p - 1.0) * (p - 2.0) / 2.0 * values.row(k) -
        (p + 1.0) * p * (p - 2.0) / 2.0 * values.row(k + 1) +
        (p + 1.0) * p * (p - 1.0) / 6.0 * values.row(k + 2);
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
  out.step = kStride * first_;
  const auto rows = static_cast<Index>((t.back() - t.front()) / out.step) + 1;
  out.values = SignalRows::Zero(rows, values.cols());
  out.whole.assign(static_cast<std::size_t>(rows), 0);
  LocalLines lines(first_, &out);
  for (std::size_t k = 0; k < t.size(); ++k) lines.add(t[k], values.row(static_cast<Index>(k)));
  lines.finish();
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
  EvenSignals out{from.begin, from.step, SignalRows(from.values.rows(), from.values.cols()),
                  shrunk(from.whole, reach)};
  for (Index row = 0; row < from.values.rows(); ++row) {
    if (out.whole[static_cast<std::size_t>(row)] == 0) {
      out.values.row(row).setZero();
      continue;
    }
    out.values.row(row).noalias() =
        weights.transpose() * from.values.middleRows(row - reach, 2 * reach + 1);
  }
  return out;
}

EvenSignals BandFilter::force(const std::vector<double>& t, const Eigen::MatrixXd& force) const {
  return smoothed(sampled(t, force));
}

EvenSignals BandFilter::pose(const std::vector<double>& t, const Eigen::MatrixXd& pose) const {
  EvenSignals signals = sampled(t, pose);
  const SignalRows samples = std::move(signals.values);
  const double h = signals.step;
  const SignalRows w = body_rates(samples, h);
  signals.whole = shrunk(signals.whole, 2);
  double square = 0.0, count = 0.0;
  for (Index k = 0; k < samples.rows(); ++k) {
    if (signals.whole[static_cast<std::size_t>(k)] == 0) continue;
    square += slope_at<3>(samples, k, h).squaredNorm();
    count += 1.0;
  }
  const double slow = kSlowPart * std::sqrt(square / std::max(1.0, count)) + 1e-12;
  signals.values.resize(samples.rows(), 22);
  for (Index k = 0; k < samples.rows(); ++k) {
    const Eigen::Matrix3d to_body = turn_in(samples, k).toRotationMatrix().transpose();
    const Vector3 v = to_body * slope_at<3>(samples, k, h).transpose();
    const Vector3 rate = w.row(k).transpose();
    signals.values.row(k) << to_body.col(2).transpose(),
        (to_body * bend_at(samples, k, h)).transpose(), slope_at<3>(w, k, h),
        rate.cwiseAbs2().transpose(), rate.x() * rate.y(), rate.y() * rate.z(), rate.z() * rate.x(),
        v.transpose(), v.transpose() / std::hypot(v.norm(), slow), 1.0;
  }
  return smoothed(signals);
}

}  // namespace dcnn
