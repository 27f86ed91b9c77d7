// SPDX-License-Identifier: Apache-2.0
#include "dcnn/identification/forward_fit.h"

#include <algorithm>
#include <cmath>

#include "core/linear_algebra.h"
#include "dcnn/core/number.h"
#include "dcnn/core/parallel.h"

namespace dcnn {
namespace {

constexpr double kUnsettled = 0.05;   // of a recording's rows
constexpr double kDifference = 1e-3;  // of a number, for derivatives
constexpr double kTolerance = 1e-6;   // of the integrator, below what a difference changes
constexpr double kConverged = 1e-7;   // of the squares, in one step
constexpr int kMostSteps = 60;

Index first_settled(Index rows) { return static_cast<Index>(kUnsettled * double(rows)); }

/// Squares are least in one vector over all recordings; empty where the model does not move.
Eigen::VectorXd misses(const AxisMachine& machine, std::size_t axis,
                       const std::vector<Recording>& recordings) {
  std::vector<double> all;
  for (const Recording& recording : recordings) {
    Eigen::MatrixXd motion;
    try {
      motion = simulated_motion(machine, axis, recording);
    } catch (const Error&) {
      return {};
    }
    const Eigen::VectorXd left =
        recording.column(machine.system.axes[axis].position) - motion.col(0);
    if (!left.allFinite()) return {};
    all.insert(all.end(), left.data() + first_settled(left.size()), left.data() + left.size());
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), Index(all.size()));
}

}  // namespace

Eigen::MatrixXd simulated_motion(const AxisMachine& machine, std::size_t axis,
                                 const Recording& recording) {
  const Axis& own = machine.system.axes[axis];
  require(!own.position.empty(), Exit::kData, "axis '", own.name,
          "': no position to begin from; name its column in the system description");
  require(recording.segments.size() == 1, Exit::kData, recording.name,
          ": rows are missing, and a motion cannot be simulated across the gap; cut the recording "
          "there");
  const ForwardAxis forward(machine, axis, recording.dt, recording.name, Exit::kData);
  const Motion motion = axis_motion(recording, own, machine.axes[axis].derivative);
  return forward.run(own.scale * recording.column(own.measured), motion.euler(0, 0),
                     motion.v_B(0, 0), kTolerance);
}

ForwardError error_of(const Eigen::MatrixXd& simulated, const Recording& recording,
                      const Axis& axis) {
  const Eigen::VectorXd left = recording.column(axis.position) - simulated.col(0);
  const Index first = first_settled(left.size());
  return {std::sqrt(left.squaredNorm() / double(left.size())),
          std::sqrt(left.tail(left.size() - first).squaredNorm() / double(left.size() - first))};
}

ForwardFit refine_forward(const AxisMachine& machine, std::size_t axis,
                          const std::vector<Recording>& recordings,
                          const std::function<void(const std::string&)>& progress) {
  const ForwardNumbers numbers(machine, axis);
  const std::string& unit = machine.system.axes[axis].position_unit;
  ForwardFit fit{machine, numbers.names(), numbers.values(machine), {}, {}, 0.0, 0.0, 0};
  Eigen::VectorXd x = fit.before, left = misses(machine, axis, recordings);
  require(left.size() > 0, Exit::kData, "axis '", machine.system.axes[axis].name,
          "': the model as given has no bounded motion under these drives; diagnose it first");
  const auto with = [&](const Eigen::VectorXd& values) {
    AxisMachine other = machine;
    numbers.set(other, values);
    return other;
  };
  const double rows = double(left.size());
  fit.rmse_before = std::sqrt(left.squaredNorm() / rows);
  double damping = 1e-3;
  Eigen::MatrixXd J(left.size(), x.size());
  for (; fit.steps < kMostSteps; ++fit.steps) {
    progress("step " + std::to_string(fit.steps) + ": " +
             brief(std::sqrt(left.squaredNorm() / rows)) + " " + unit);
    for_each_piece(x.size(), [&](Index k) {
      Eigen::VectorXd moved = x;
      const double step = kDifference * (x(k) != 0.0 ? x(k) : 1.0);
      moved(k) += step;
      const Eigen::VectorXd other = misses(with(moved), axis, recordings);
      if (other.size() == left.size()) {
        J.col(k) = (left - other) / step;
      } else {
        J.col(k).setZero();
      }
    });
    const Eigen::MatrixXd gram = J.transpose() * J;
    const Eigen::VectorXd slope = J.transpose() * left;
    bool better = false;
    double gained = 0.0;
    for (; !better && damping < 1e8; damping *= 10.0) {
      const Eigen::VectorXd tried = x + solve_gram(gram, slope, damping).col(0);
      const Eigen::VectorXd other = misses(with(tried), axis, recordings);
      if (other.size() != left.size() || !(other.squaredNorm() < left.squaredNorm())) continue;
      gained = 1.0 - other.squaredNorm() / left.squaredNorm();
      x = tried;
      left = other;
      better = true;
    }
    damping = std::max(1e-9, damping / 100.0);
    if (!better || gained < kConverged) break;
  }
  fit.machine = with(x);
  fit.after = x;
  fit.rmse_after = std::sqrt(left.squaredNorm() / rows);
  const Eigen::MatrixXd inverse =
      solve_gram(J.transpose() * J, Eigen::MatrixXd::Identity(x.size(), x.size()), 0.0);
  fit.deviation = fit.rmse_after * inverse.diagonal().cwiseMax(0.0).cwiseSqrt();
  return fit;
}

}  // namespace dcnn
