// SPDX-License-Identifier: Apache-2.0
#include "dcnn/import/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/elementary.h"
#include "dcnn/core/error.h"
#include "import/clock_signals.h"

namespace dcnn {
namespace {

constexpr Index kBlocks = 10;          // left out in turn
constexpr double kStudent975 = 2.262;  // of ten estimates
constexpr double kChi975 = 3.841;      // chi-square of one number, 95 %
constexpr double kSure = 16.0;         // of another valley: 4 standard deviations
constexpr double kLowestBand = 0.5, kHighestBand = 16.0;  // Hz, where arms move
constexpr double kNearestBand = 0.044;  // of the slower rate: Gaussians of one step, BandFilter
constexpr Index kMostRows = 4000;
constexpr Index kFewestFree = 60;  // independent numbers beyond those that are fitted
constexpr double kRidge = 1e-9;    // of each regressor's own power: nearly equal ones stay solvable

/// Sums of least squares for one shift and one block of time, force by force.
struct Sums {
  Eigen::MatrixXd xx, xy;
  Eigen::Vector3d yy = Eigen::Vector3d::Zero();
  double rows = 0.0;

  explicit Sums(Index count)
      : xx(Eigen::MatrixXd::Zero(count, count)), xy(Eigen::MatrixXd::Zero(count, 3)) {}
  Sums(const Eigen::Ref<const SignalRows>& x, const Eigen::Ref<const SignalRows>& y)
      : Sums(x.cols()) {
    xx.selfadjointView<Eigen::Lower>().rankUpdate(x.transpose());
    xx.triangularView<Eigen::StrictlyUpper>() = xx.transpose();
    xy.noalias() = x.transpose() * y;
    yy = y.colwise().squaredNorm().transpose();
    rows = static_cast<double>(x.rows());
  }
  void add(const Sums& other, double sign) {
    xx += sign * other.xx;
    xy += sign * other.xy;
    yy += sign * other.yy;
    rows += sign * other.rows;
  }
  /// What a linear combination of the regressors leaves of the forces.
  double residual() const {
    const Eigen::VectorXd scale = xx.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    Eigen::MatrixXd scaled = scale.asDiagonal() * xx * scale.asDiagonal();
    scaled.diagonal().array() += kRidge;
    const Eigen::MatrixXd b = scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * xy);
    double sum = 0.0;
    for (Index k = 0; k < 3; ++k) {
      sum += yy[k] - 2.0 * b.col(k).dot(xy.col(k)) + b.col(k).dot(xx * b.col(k));
    }
    return std::max(1e-300, sum);
  }
};

using BlockSums = std::vector<Sums>;

/// Least squares at many shifts, on the same rows.
struct Scan {
  std::vector<double> shifts;
  std::vector<BlockSums> sums;

  /// Residuals over the shifts without one block (-1: with all).
  std::vector<double> residuals(Index without) const {
    std::vector<double> values;
    for (const BlockSums& blocks : sums) {
      Sums total = blocks[0];
      for (std::size_t k = 1; k < blocks.size(); ++k) total.add(blocks[k], 1.0);
      if (without >= 0) total.add(blocks[static_cast<std::size_t>(without)], -1.0);
      values.push_back(total.residual());
    }
    return values;
  }
};

/// Force and pose of one band of frequencies.
class Band {
 public:
  Band(const ClockPair& pair, double hz, double margin)
      : filter_(hz),
        force_(filter_.force(pair.t, pair.force)),
        pose_(filter_.pose(pair.pose_t, pair.pose)) {
    const double begin = std::max(force_.begin, pose_.begin + margin);
    const double end = std::min(last(force_), last(pose_) - margin);
    const double stride = std::max(4.0, (end - begin) / (force_.step * double(kMostRows)));
    Eigen::RowVectorXd x(pose_.values.cols());
    for (double at = 0.0; at < static_cast<double>(force_.values.rows()); at += stride) {
      const auto row = static_cast<Index>(at);
      const double t = time_of(row);
      if (force_.whole[static_cast<std::size_t>(row)] == 0 || t < begin || t > end) continue;
      if (pose_.at(t - margin, x) && pose_.at(t + margin, x) && pose_.at(t, x)) {
        rows_.push_back(row);
      }
    }
    covered_ = static_cast<double>(rows_.size()) * stride * force_.step;
  }

  /// Independent numbers of the force beyond the regressors' coefficients.
  double free() const {
    return 3.0 * (covered_ * filter_.independent() - static_cast<double>(pose_.values.cols()) - 1);
  }
  double power() const { return static_cast<double>(rows_.size()) * 3.0; }

  Scan scan(double centre, double reach, Index steps) const {
    Scan scan;
    for (Index k = -steps; k <= steps; ++k) {
      scan.shifts.push_back(centre + reach * static_cast<double>(k) / static_cast<double>(steps));
      scan.sums.push_back(sums_of(scan.shifts.back()));
    }
    return scan;
  }

 private:
  double time_of(Index row) const { return force_.begin + force_.step * static_cast<double>(row); }
  static double last(const EvenSignals& s) {
    return s.begin + s.step * static_cast<double>(s.values.rows() - 1);
  }

  BlockSums sums_of(double shift) const {
    BlockSums blocks(static_cast<std::size_t>(kBlocks), Sums(pose_.values.cols()));
    SignalRows x(static_cast<Index>(rows_.size()), pose_.values.cols());
    SignalRows y(x.rows(), 3);
    std::size_t begin = 0;
    for (std::size_t block = 0; block < blocks.size(); ++block) {
      Index count = 0;
      for (; begin < rows_.size() && begin * blocks.size() / rows_.size() == block; ++begin) {
        if (!pose_.at(time_of(rows_[begin]) - shift, x.row(count))) continue;
        y.row(count++) = force_.values.row(rows_[begin]);
      }
      blocks[block] = Sums(x.topRows(count), y.topRows(count));
    }
    return blocks;
  }

  BandFilter filter_;
  EvenSignals force_, pose_;
  std::vector<Index> rows_;
  double covered_ = 0.0;  // s
};

/// The smallest value of a parabola through the least of equally spaced values and its neighbours.
double lowest(const std::vector<double>& shifts, const std::vector<double>& values) {
  const auto least = std::min_element(values.begin(), values.end()) - values.begin();
  const auto k = static_cast<std::size_t>(least);
  if (k == 0 || k + 1 == values.size()) return shifts[k];
  const double bend = values[k - 1] - 2.0 * values[k] + values[k + 1];
  const double slope = 0.5 * (values[k + 1] - values[k - 1]);
  const double step = shifts[1] - shifts[0];
  return bend > 0.0 ? shifts[k] - step * slope / bend : shifts[k];
}

/// What one band says.
struct BandEstimate {
  double hz = 0.0, seconds = 0.0, half = 0.0;
  bool alone = false;  ///< no other shift explains the force nearly as well
  std::vector<double> shifts, residual_rms;
};

/// Half of the width within which -2 log of the likelihood rises by less than chi-square's 95 %.
double profile_half(const Scan& scan, const std::vector<double>& values, double free) {
  const double least = *std::min_element(values.begin(), values.end());
  double low = 0.0, high = 0.0;
  bool any = false;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (free * elementary::log(values[k] / least) > kChi975) continue;
    if (!any) low = scan.shifts[k];
    high = scan.shifts[k];
    any = true;
  }
  return 0.5 * (high - low + 2.0 * (scan.shifts[1] - scan.shifts[0]));
}

std::optional<BandEstimate> estimate_in(const ClockPair& pair, double hz, double most) {
  constexpr Index kCoarse = 50, kFine = 20;
  const double step = most / static_cast<double>(kCoarse);
  const Band band(pair, hz, most + 2.0 * step);
  if (band.free() < static_cast<double>(kFewestFree)) return std::nullopt;
  BandEstimate found;
  found.hz = hz;
  const Scan coarse = band.scan(0.0, most, kCoarse);
  const std::vector<double> profile = coarse.residuals(-1);
  const double first = lowest(coarse.shifts, profile);
  const Scan fine = band.scan(first, 2.0 * step, kFine);
  const std::vector<double> valley = fine.residuals(-1);
  found.seconds = lowest(fine.shifts, valley);
  double mean = 0.0, square = 0.0;
  for (Index block = 0; block < kBlocks; ++block) {
    const double shift = lowest(fine.shifts, fine.residuals(block)) - found.seconds;
    mean += shift / static_cast<double>(kBlocks);
    square += shift * shift / static_cast<double>(kBlocks);
  }
  const double sd =
      std::sqrt(static_cast<double>(kBlocks - 1) * std::max(0.0, square - mean * mean));
  const Scan near = band.scan(found.seconds, 2.0 * kStudent975 * sd + 1e-6, kFine);
  found.half = std::max(kStudent975 * sd, profile_half(near, near.residuals(-1), band.free()));
  found.alone = std::abs(first) < most - step;
  const double least = *std::min_element(valley.begin(), valley.end());
  for (std::size_t k = 0; k < profile.size(); ++k) {
    found.residual_rms.push_back(std::sqrt(profile[k] / std::max(1.0, band.power())));
    const bool far = std::abs(coarse.shifts[k] - found.seconds) > found.half + 1.5 * step;
    if (far && band.free() * elementary::log(profile[k] / least) < kSure) found.alone = false;
  }
  found.shifts = coarse.shifts;
  return found;
}

}  // namespace

ClockOffset estimate_clock_offset(const ClockPair& pair, double most) {
  ClockOffset result;
  constexpr std::size_t kFewest = 50;
  if (pair.t.size() < kFewest || pair.pose_t.size() < kFewest) return result;
  const double common =
      std::min(pair.t.back(), pair.pose_t.back()) - std::max(pair.t.front(), pair.pose_t.front());
  most = std::min(most, 0.25 * common);
  if (most <= 0.0) return result;
  const double highest = kNearestBand / pair.step;
  std::optional<BandEstimate> best, below;
  for (double hz = kLowestBand; hz <= std::min(kHighestBand, highest); hz *= 2.0) {
    auto here = estimate_in(pair, hz, most);
    if (!here) continue;
    if (below) here->half = std::max(here->half, std::abs(here->seconds - below->seconds));
    below = here;
    if (!best || here->half < best->half) best = here;
  }
  if (!best) return result;
  result.seconds = best->seconds;
  result.half = best->half;
  result.shifts = best->shifts;
  result.residual_rms = best->residual_rms;
  result.certain = best->alone && best->half < pair.step;
  return result;
}

}  // namespace dcnn
