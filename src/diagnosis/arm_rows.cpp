// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/arm_rows.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/linear_algebra.h"
#include "dcnn/data/filter.h"
#include "dcnn/physics/axis_machine.h"
#include "diagnosis/holdout.h"
#include "diagnosis/left_out.h"
#include "diagnosis/rest.h"

namespace dcnn {
namespace {

constexpr double kTailFreedom = 4.0;  // of Student's t
constexpr int kTailPasses = 20;       // of expectation and maximisation
constexpr double kTailRidge = 1e-9;   // of columns' squared length
constexpr double kDryWidths[] = {0.005, 0.05, 0.3,
                                 1.5};  // of the rms velocity, in which friction turns

bool is_within(const std::vector<Span>& spans, std::size_t log, double t) {
  return std::any_of(spans.begin(), spans.end(), [&](const Span& s) { return s.holds(log, t); });
}

Eigen::MatrixXd friction_columns(const Motion& motion) {
  const Eigen::ArrayXd v = motion.v_B.col(0).array();
  const double size = std::sqrt(v.square().mean());
  Eigen::MatrixXd columns(v.size(), kOwnFriction);
  columns.col(0).setOnes();
  columns.col(1) = v.matrix();
  Index k = 2;
  for (const double width : kDryWidths) {
    columns.col(k++) = elementary::tanh(v / std::max(1e-12, width * size)).matrix();
  }
  return columns;
}

/// Effects of one joint that look like a body at the flange on that joint alone.
Eigen::MatrixXd alias_columns(const Motion& motion, const Eigen::VectorXd& given) {
  const Index n = given.size();
  const Eigen::ArrayXd v = motion.v_B.col(0).array();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, kOwnAliases);
  columns.col(0) = motion.euler.col(0);
  columns.col(1) = (v * v.abs()).matrix();
  columns.col(2) = motion.a_B.col(0);
  columns.col(3) = given;
  for (Index i = 1; i + 1 < n; ++i) {
    columns(i, 4) =
        (given(i + 1) - given(i - 1)) / std::max(1e-12, motion.t(i + 1) - motion.t(i - 1));
  }
  const double size = std::max(1e-12, kDryWidths[1] * std::sqrt(v.square().mean()));
  columns.col(5) = (given.array().abs() * elementary::tanh(v / size)).matrix();
  return columns;
}

struct LogRows {
  Eigen::MatrixXd arm, own;
  Eigen::VectorXd target;
};

LogRows rows_of_log(const Case& study, const Log& log, const Eigen::VectorXd& bodies) {
  const AxisPlan& plan = *study.axis;
  const auto filtered = [&](const Eigen::MatrixXd& columns) {
    return low_pass(columns, log.recording, plan.system.lowpass_hz);
  };
  LogRows rows;
  System free = plan.system;  // the links' columns, whatever simulates the axis
  free.axes[plan.index].simulated.clear();
  rows.arm = plan.sense * filtered(base_columns(log.recording, free, plan.index, study.derivative));
  rows.own = filtered(friction_columns(log.motion));
  rows.target = -plan.sense * log.measured.col(0);
  const std::string& simulated = plan.axis().simulated;
  if (simulated.empty() && bodies.size() == 0) return rows;
  const Eigen::VectorXd given = simulated.empty()
                                    ? Eigen::VectorXd(rows.arm * bodies)
                                    : Eigen::VectorXd(filtered(log.recording.column(simulated)));
  rows.target -= given;
  rows.own.conservativeResize(Eigen::NoChange, kOwnFriction + kOwnAliases);
  rows.own.rightCols(kOwnAliases) = filtered(alias_columns(log.motion, given));
  return rows;
}

}  // namespace

JointRows rows_of(const LoadedCase& loaded, const Eigen::VectorXd& bodies) {
  const Case& study = loaded.fit;
  std::vector<Span> without =
      loaded.holdout.logs.empty() ? held_out_blocks(study, true) : std::vector<Span>();
  const bool is_given = bodies.size() > 0 || !study.axis->axis().simulated.empty();
  if (is_given) {
    const std::vector<Span> still = rests(study);
    without.insert(without.end(), still.begin(), still.end());
  }
  JointRows all;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const Log& log = study.logs[k];
    const LogRows rows = rows_of_log(study, log, bodies);
    // Two samples in a period of the fastest motion, times two.
    const Index stride = std::max<Index>(1, std::llround(0.25 / study.shown_hz() / study.dt()));
    std::vector<Index> kept;
    for (Index i = 0; i < rows.arm.rows(); i += stride) {
      const double t = log.motion.t(i);
      if (is_within(without, k, t)) continue;
      kept.push_back(i);
      all.piece.push_back(static_cast<Index>(k) * kRecordingParts + part_of(log.motion, t));
    }
    const Index before = all.arm.rows(), more = static_cast<Index>(kept.size());
    all.arm.conservativeResize(before + more, rows.arm.cols());
    all.own.conservativeResize(before + more, rows.own.cols());
    all.target.conservativeResize(before + more);
    all.arm.bottomRows(more) = rows.arm(kept, Eigen::all);
    all.own.bottomRows(more) = rows.own(kept, Eigen::all);
    all.target.tail(more) = rows.target(kept);
  }
  if (is_given) weigh_by_tails(all);
  return all;
}

void weigh_by_tails(JointRows& rows) {
  const Index n = rows.target.size(), arm = rows.arm.cols();
  Eigen::MatrixXd all(n, arm + rows.own.cols());
  if (n < 2 * all.cols()) return;
  all << rows.arm, rows.own;
  Eigen::ArrayXd weight = Eigen::ArrayXd::Ones(n);
  for (int pass = 0; pass < kTailPasses; ++pass) {
    const Eigen::MatrixXd weighed = weight.matrix().asDiagonal() * all;
    const Eigen::VectorXd x =
        solve_gram(weighed.transpose() * all, weighed.transpose() * rows.target, kTailRidge);
    const Eigen::ArrayXd square = (rows.target - all * x).array().square();
    const double variance = std::max(1e-300, (weight * square).mean());
    weight = (kTailFreedom + 1.0) / (kTailFreedom + square / variance);
  }
  const Eigen::VectorXd root = weight.sqrt();
  rows.arm = root.asDiagonal() * rows.arm;
  rows.own = root.asDiagonal() * rows.own;
  rows.target = root.asDiagonal() * rows.target;
}

}  // namespace dcnn
