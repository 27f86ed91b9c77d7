// SPDX-License-Identifier: Apache-2.0
// The noise of poses at rest.
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/elementary.h"
#include "core/linear_algebra.h"
#include "dcnn/core/error.h"
#include "dcnn/diagnosis/decision.h"
#include "diagnosis/noise_floor.h"

namespace dcnn {

namespace {

/// Poses at rest and what is left of each channel there.
struct Poses {
  std::vector<Eigen::Matrix3d> R_BS;
  Eigen::VectorXd drift;  ///< time over the span; empty for lists without times
  Eigen::MatrixXd left;

  Index count() const { return left.rows(); }
  Index width() const { return drift.size() > 0 ? 5 : 4; }

  /// Columns: the vertical u of the base in the sensor's frame, R' u, an offset and its drift.
  Eigen::MatrixXd columns(const Eigen::Vector3d& u) const {
    Eigen::MatrixXd A(count(), width());
    for (Index i = 0; i < count(); ++i) {
      A.row(i).head<3>() = (R_BS[static_cast<std::size_t>(i)].transpose() * u).transpose();
      A(i, 3) = 1.0;
      if (drift.size() > 0) A(i, 4) = drift(i);
    }
    return A;
  }
  /// Squares that a free matrix on the vertical u, an offset and its drift leave of each channel.
  Eigen::VectorXd squares(const Eigen::Vector3d& u) const {
    const Eigen::MatrixXd A = columns(u);
    Eigen::MatrixXd gram = A.transpose() * A;
    gram.diagonal().array() += 1e-9;
    Eigen::VectorXd squares(left.cols());
    for (Index j = 0; j < left.cols(); ++j) {
      const Eigen::VectorXd match = A.transpose() * left.col(j);
      squares(j) = (left.col(j) - A * solve_symmetric(gram, match)).squaredNorm();
    }
    return squares;
  }
  /// Chi-square of u, each channel in units of the deviation that `nominal` leaves of it: sum_j
  /// S_j(u) n/S_j(nominal). A likelihood with variances of its own would grow without bound where
  /// one channel of few poses happens to be met exactly.
  double chi2(const Eigen::Vector3d& u, const Eigen::VectorXd& nominal) const {
    const double dof = static_cast<double>(count() - width());
    return dof * squares(u).cwiseQuotient(nominal.cwiseMax(1e-300)).sum();
  }
};

/// Another vertical of the base than `nominal`, where the poses show one beyond the price of its
/// two numbers: a robot on a wall or a ceiling, whose description has it upright.
std::optional<Eigen::Vector3d> other_vertical(const Poses& poses, const Eigen::Vector3d& nominal) {
  constexpr int kDirections = 200;               // over half a sphere: 10 degrees apart
  constexpr double kGolden = 2.399963229728653;  // rad, pi (3 - sqrt 5): points spread evenly
  constexpr double kLastStep = 1e-4;             // rad
  const Eigen::VectorXd squares = poses.squares(nominal);
  const double before = poses.chi2(nominal, squares);
  double least = before;
  Eigen::Vector3d best = nominal;
  const auto take = [&](const Eigen::Vector3d& u) {
    const double cost = poses.chi2(u, squares);
    if (cost >= least) return false;
    least = cost, best = u;
    return true;
  };
  for (int k = 0; k < kDirections; ++k) {
    const double z = (k + 0.5) / kDirections, r = std::sqrt(1.0 - z * z), turn = kGolden * k;
    take({r * elementary::cos(turn), r * elementary::sin(turn), z});
  }
  for (double step = 0.1; step > kLastStep;) {
    const Eigen::Vector3d a = best.unitOrthogonal(), b = best.cross(a), from = best;
    bool better = false;
    for (const Eigen::Vector3d& side : {a, b}) {
      for (const double sign : {1.0, -1.0}) {
        better = take((from + sign * step * side).normalized()) || better;
      }
    }
    if (!better) step *= 0.5;
  }
  if (before - least < 2.0 * kNumberPrice) return std::nullopt;
  return best;
}

}  // namespace

std::vector<Floor> floor_at_rest(const Case& study, const Signals& residual) {
  const double span = std::max(span_seconds(study), 1e-300);
  Poses poses;
  poses.left.resize(0, study.channel_count());
  std::vector<double> times;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const Motion& motion = study.logs[k].motion;
    for (std::size_t i = 0; i < motion.R_BS.size(); ++i) {
      poses.R_BS.push_back(motion.R_BS[i]);
      if (study.has_clock()) times.push_back(motion.t(static_cast<Index>(i)) / span);
    }
    const Index before = poses.left.rows();
    poses.left.conservativeResize(before + residual[k].rows(), Eigen::NoChange);
    poses.left.bottomRows(residual[k].rows()) = residual[k];
  }
  poses.drift = Eigen::Map<const Eigen::VectorXd>(times.data(), static_cast<Index>(times.size()));
  double dof = static_cast<double>(poses.count() - poses.width());
  require(dof >= 3.0, Exit::kData, study.logs.front().recording.name, ": ", poses.count(),
          " poses cannot tell noise from faults; record at least ", poses.width() + 3);
  Eigen::Vector3d vertical = Eigen::Vector3d::UnitZ();
  const auto other = other_vertical(poses, vertical);
  if (other) {
    vertical = *other;
    dof -= 2.0 / static_cast<double>(poses.left.cols());  // its two numbers, shared by the channels
  }
  const Eigen::VectorXd squares = poses.squares(vertical);
  std::vector<Floor> floors;
  for (Index j = 0; j < squares.size(); ++j) {
    Floor floor;
    floor.white = squares(j) / dof;
    floor.source = std::string("poses at rest, beside a free matrix on gravity") +
                   (other ? " in a base that is not upright" : "") +
                   (study.has_clock() ? ", an offset and its drift" : " and an offset");
    floors.push_back(floor);
  }
  return floors;
}

}  // namespace dcnn
