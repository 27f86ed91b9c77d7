#include "dcnn/import/clock_offset.h"

#include <algorithm>
#include <cmath>

#include "data/spline.h"
#include "dcnn/core/error.h"

namespace dcnn {
namespace {

constexpr Index kRegressors = 7;  // vertical, acceleration of the origin, a constant
constexpr Index kBlocks = 10;     // left out in turn
constexpr Index kMostRows = 4000;
constexpr double kNormal975 = 1.959963984540054;

/// Sums of least squares for one shift and one block of time, force by force.
struct Sums {
  Eigen::Matrix<double, kRegressors, kRegressors> xx =
      Eigen::Matrix<double, kRegressors, kRegressors>::Zero();
  Eigen::Matrix<double, kRegressors, 3> xy = Eigen::Matrix<double, kRegressors, 3>::Zero();
  Eigen::Vector3d yy = Eigen::Vector3d::Zero();
  double rows = 0.0;

  void add(const Sums& other, double sign) {
    xx += sign * other.xx;
    xy += sign * other.xy;
    yy += sign * other.yy;
    rows += sign * other.rows;
  }
  /// What a linear combination of the regressors leaves of the forces.
  double residual() const {
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(xx);
    const Eigen::MatrixXd b = solver.solve(xy);
    double sum = 0.0;
    for (Index k = 0; k < 3; ++k) sum += yy[k] - b.col(k).dot(xy.col(k));
    return std::max(0.0, sum);
  }
};

/// Splines of a pose's signals: vertical and acceleration, both in the sensor's frame.
class PoseSignals {
 public:
  PoseSignals(const std::vector<double>& t, const Eigen::MatrixXd& pose) : t_(t) {
    const Eigen::VectorXd clock =
        Eigen::Map<const Eigen::VectorXd>(t.data(), static_cast<Index>(t.size()));
    Eigen::MatrixXd acceleration = Eigen::MatrixXd::Zero(pose.rows(), 3);
    for (Index k = 0; k < 3; ++k) acceleration.col(k) = Spline(clock, pose.col(k)).curvature();
    Eigen::MatrixXd signals(pose.rows(), 6);
    for (Index row = 0; row < pose.rows(); ++row) {
      const Eigen::Quaterniond q(pose(row, 3), pose(row, 4), pose(row, 5), pose(row, 6));
      const Eigen::Matrix3d R_t = q.normalized().toRotationMatrix().transpose();
      signals.row(row) << (R_t * Eigen::Vector3d::UnitZ()).transpose(),
          (R_t * acceleration.row(row).transpose()).transpose();
    }
    for (Index k = 0; k < 6; ++k) splines_.emplace_back(clock, signals.col(k));
  }

  /// False outside of the pose's times.
  bool at(double time, Eigen::Matrix<double, kRegressors, 1>* x) const {
    const Index after = std::upper_bound(t_.begin(), t_.end(), time) - t_.begin();
    if (after == 0 || after == static_cast<Index>(t_.size())) return false;
    for (std::size_t k = 0; k < 6; ++k) {
      (*x)[static_cast<Index>(k)] = splines_[k].value(time, after - 1);
    }
    (*x)[6] = 1.0;
    return true;
  }

 private:
  const std::vector<double>& t_;
  std::vector<Spline> splines_;
};

using BlockSums = std::vector<Sums>;

/// Of one shift: the sums of each block. Rows that some shift would leave out are left out by all.
BlockSums sums_of(const PoseSignals& pose, const ClockPair& pair, double shift, double reach) {
  BlockSums blocks(kBlocks);
  const double begin = std::max(pair.t.front(), pair.pose_t.front() + reach);
  const double end = std::min(pair.t.back(), pair.pose_t.back() - reach);
  const auto count = static_cast<Index>(pair.t.size());
  const Index stride = std::max<Index>(1, count / kMostRows);
  for (Index row = 0; row < count; row += stride) {
    const double t = pair.t[static_cast<std::size_t>(row)];
    Eigen::Matrix<double, kRegressors, 1> x;
    if (t < begin || t > end || !pose.at(t - shift, &x)) continue;
    const auto block = static_cast<Index>((t - begin) / (end - begin) * kBlocks);
    Sums& sums = blocks[static_cast<std::size_t>(std::min(block, kBlocks - 1))];
    const Eigen::Vector3d y = pair.force.row(row).transpose();
    sums.xx += x * x.transpose();
    sums.xy += x * y.transpose();
    sums.yy += y.cwiseAbs2();
    sums.rows += 1.0;
  }
  return blocks;
}

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

struct Scan {
  std::vector<double> shifts;
  std::vector<BlockSums> sums;

  /// Residuals over the shifts without one block (-1: with all).
  std::vector<double> residuals(Index without) const {
    std::vector<double> values;
    for (const BlockSums& blocks : sums) {
      Sums total;
      for (const Sums& block : blocks) total.add(block, 1.0);
      if (without >= 0) total.add(blocks[static_cast<std::size_t>(without)], -1.0);
      values.push_back(total.residual());
    }
    return values;
  }
};

Scan scan_shifts(const PoseSignals& pose, const ClockPair& pair, double centre, double reach,
                 Index steps, double margin) {
  Scan scan;
  for (Index k = -steps; k <= steps; ++k) {
    scan.shifts.push_back(centre + reach * static_cast<double>(k) / static_cast<double>(steps));
    scan.sums.push_back(sums_of(pose, pair, scan.shifts.back(), margin));
  }
  return scan;
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
  const PoseSignals pose(pair.pose_t, pair.pose);
  constexpr Index kCoarse = 50, kFine = 20;
  const Scan coarse = scan_shifts(pose, pair, 0.0, most, kCoarse, most);
  const std::vector<double> profile = coarse.residuals(-1);
  const double first = lowest(coarse.shifts, profile);
  const double step = most / static_cast<double>(kCoarse);
  // The estimates without a block scatter over the width of the valley, not over the scan.
  const Scan fine = scan_shifts(pose, pair, first, 4.0 * step, kFine, most + 4.0 * step);
  result.seconds = lowest(fine.shifts, fine.residuals(-1));
  double mean = 0.0, square = 0.0;
  for (Index block = 0; block < kBlocks; ++block) {
    const double shift = lowest(fine.shifts, fine.residuals(block));
    mean += shift / static_cast<double>(kBlocks);
    square += shift * shift / static_cast<double>(kBlocks);
  }
  const double spread = std::max(0.0, square - mean * mean);
  result.sd = std::sqrt(static_cast<double>(kBlocks - 1) * spread);  // jackknife
  result.shifts = coarse.shifts;
  double rows = 0.0;
  for (const Sums& block : coarse.sums[kCoarse]) rows += 3.0 * block.rows;
  for (const double value : profile) {
    result.residual_rms.push_back(std::sqrt(value / std::max(1.0, rows)));
  }
  const bool inside = std::abs(first) < most - step;
  const bool valley = std::abs(result.seconds - first) < 3.0 * step;
  result.certain = inside && valley && kNormal975 * result.sd < pair.step;
  return result;
}

}  // namespace dcnn
