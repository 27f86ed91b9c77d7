// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/axis_sense.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "data/median.h"
#include "data/reversals.h"
#include "dcnn/physics/axis_machine.h"
#include "diagnosis/evidence/priors.h"

namespace dcnn {
namespace {

constexpr double kLongestDelay = 0.6;  // s, as delays are looked for (effects/time_delay.cpp)
constexpr int kDelays = 60;            // either way: steps that no motion below 10 Hz turns in

/// Offset, velocity, acceleration, position of one recording; what a simulator of the user's
/// predicts, whose scale may be wrong; of a turning axis its sine and cosine (a link in gravity)
/// and their rates, for a weight read some milliseconds late is no drag; and its reading. All have
/// passed the filter that derivatives pass, where that is one: beyond it a position would stand for
/// the inertia.
constexpr Index kColumns = 9, kGravity = 5, kVelocity = 1, kAcceleration = 2, kPlace = 3,
                kSimulated = 4, kRates = 7;
struct LaggedRows {
  Eigen::MatrixXd motion;
  Eigen::VectorXd reading;
  std::vector<Segment> segments;
  double dt = 0.0;
  Index stride = 1;
};

/// Sums of a regression of the reading on the motion `delay` rows before.
struct LaggedSums {
  Eigen::Matrix<double, kColumns, kColumns> gram =
      Eigen::Matrix<double, kColumns, kColumns>::Zero();
  Eigen::Vector<double, kColumns> match = Eigen::Vector<double, kColumns>::Zero();
  double square = 0.0, sum = 0.0, rows = 0.0;

  void add(const LaggedRows& log, Index delay) {
    for (const Segment& s : log.segments) {
      const Index begin = std::max(s.begin, s.begin + delay), end = std::min(s.end, s.end + delay);
      if (end <= begin) continue;
      const Eigen::MatrixXd A =
          log.motion(Eigen::seq(begin - delay, end - delay - 1, log.stride), Eigen::all);
      const Eigen::VectorXd y = log.reading(Eigen::seq(begin, end - 1, log.stride));
      gram.noalias() += A.transpose() * A;
      match.noalias() += A.transpose() * y;
      square += y.squaredNorm();
      sum += y.sum();
      rows += static_cast<double>(y.size());
    }
  }
};

struct SenseFit {
  double sense = 1.0;
  double left = 1.0;  ///< share of the reading's variance
  double more = 0.0;  ///< the same without the term that tells the sense, beyond `left`
};

/// Of the first so many columns. `pieces`: independent ones of the motion; a weight of no more than
/// the reading comes by the usual delay late, which bounds what its rates explain.
SenseFit sense_fit(const LaggedSums& sums, Index columns, double pieces) {
  Eigen::MatrixXd gram = sums.gram.topLeftCorner(columns, columns);
  const double late = sums.rows / std::max(1.0, pieces) / (prior::kUsualDelay * prior::kUsualDelay);
  for (Index c = kRates; c < columns; ++c) gram(c, c) += late;
  const Eigen::VectorXd scale = gram.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = scale.asDiagonal() * gram * scale.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  const Eigen::MatrixXd inverse = scaled.inverse();
  const Eigen::VectorXd match = scale.cwiseProduct(sums.match.head(columns));
  // In units of their own deviations, up to the noise's.
  const Eigen::VectorXd estimate = (inverse * match).cwiseQuotient(inverse.diagonal().cwiseSqrt());
  const double along_v = estimate(kVelocity), along_a = estimate(kAcceleration);
  const double variance = sums.square - sums.sum * sums.sum / std::max(1.0, sums.rows);
  SenseFit fit;
  const double telling = std::abs(along_v) > std::abs(along_a) ? along_v : along_a;
  fit.sense = telling < 0.0 ? -1.0 : 1.0;
  fit.more = telling * telling / std::max(variance, 1e-300);
  // Rounding is what an exact simulator leaves.
  fit.left = (std::max(0.0, sums.square - match.dot(inverse * match)) + 1e-9 * sums.square) /
             std::max(variance, 1e-300);
  return fit;
}

/// The median of every five rows: single rows off their neighbours say nothing of the sense.
Eigen::VectorXd without_spikes(const Eigen::VectorXd& x) {
  constexpr Index kBeside = 2;
  Eigen::VectorXd smooth = x;
  for (Index i = kBeside; i + kBeside < x.size(); ++i) {
    smooth(i) = median({x.data() + i - kBeside, x.data() + i + kBeside + 1});
  }
  return smooth;
}

LaggedRows lagged_rows(const Recording& recording, const System& system, const Axis& axis,
                       const DerivativeSpec& derivative) {
  Targets target;
  target.names = {axis.measured};
  LaggedRows rows;
  DerivativeSpec linear = derivative;  // the same for all columns
  linear.subtraction = 0.0;
  linear.most_noise.clear();
  const Motion motion = axis_motion(recording, axis, linear);
  if (motion.v_B.rows() == 0) return rows;
  rows.motion = Eigen::MatrixXd::Zero(motion.samples(), kColumns);
  rows.motion.col(0).setOnes();
  rows.motion.col(kVelocity) = motion.v_B.col(0);
  rows.motion.col(kAcceleration) = motion.a_B.col(0);
  if (recording.has(axis.position)) {
    const Eigen::VectorXd q = recording.column(axis.position);
    rows.motion.col(kPlace) = q;
    if (axis.position_unit == "rad") {
      for (Index i = 0; i < q.size(); ++i) {
        const double v = rows.motion(i, kVelocity);
        rows.motion(i, kGravity) = elementary::sin(q(i));
        rows.motion(i, kGravity + 1) = elementary::cos(q(i));
        rows.motion(i, kRates) = v * rows.motion(i, kGravity + 1);
        rows.motion(i, kRates + 1) = v * rows.motion(i, kGravity);
      }
    }
  }
  if (recording.has(axis.simulated)) {
    rows.motion.col(kSimulated) = recording.column(axis.simulated);
  }
  rows.reading = without_spikes(measured(recording, target, system, true).col(0));
  if (recording.dt > 0.0 && linear.kind == DerivativeSpec::Kind::kSpectral) {
    const auto passed = [&](const Eigen::MatrixXd& columns) {
      return differentiate(columns, recording, linear).value;
    };
    rows.reading = passed(rows.reading);
    rows.motion.rightCols(kColumns - kPlace) = passed(rows.motion.rightCols(kColumns - kPlace));
    if (!axis.velocity.empty()) rows.motion.col(kVelocity) = passed(rows.motion.col(kVelocity));
  }
  rows.segments = recording.segments;
  rows.dt = recording.dt;
  constexpr Index kEnough = 20'000;  // rows: a limit of computation
  rows.stride = std::max<Index>(1, rows.motion.rows() / kEnough);
  return rows;
}

/// How often the axis turns back, by its position where that is logged: so many independent pieces
/// a motion has.
double turns_of(const std::vector<LaggedRows>& logs) {
  constexpr double kPart = 0.05;
  double turns = 0.0;
  for (const LaggedRows& log : logs) {
    const bool placed = !log.motion.col(kPlace).isZero(0.0);
    turns += reversals(log.motion.col(placed ? kPlace : kVelocity), kPart);
  }
  return turns;
}

}  // namespace

double sense_of(const std::vector<Recording>& recordings, const System& system, const Axis& axis,
                const DerivativeSpec& derivative) {
  std::vector<LaggedRows> logs;
  for (const Recording& recording : recordings) {
    LaggedRows rows = lagged_rows(recording, system, axis, derivative);
    if (rows.motion.rows() > 0) logs.push_back(std::move(rows));
  }
  if (logs.empty()) return 1.0;
  const double turns = turns_of(logs);
  constexpr double kStep = kLongestDelay / kDelays, kUsual = prior::kUsualDelay;
  const double delayed =
      elementary::log(prior::kName / (1.0 - prior::kName) * kStep / (2.0 * kUsual));
  const double reaction = elementary::log(prior::kReaction / (1.0 - prior::kReaction));
  double sense = 1.0, most = -1e300;
  for (int k = -kDelays; k <= kDelays; ++k) {
    LaggedSums sums;
    for (const LaggedRows& log : logs) {
      sums.add(log, std::llround(kStep * k / log.dt));
    }
    // Behind a delay a sine of the position is no weight: it would stand for friction's harmonics.
    const SenseFit fit = sense_fit(sums, k == 0 ? kColumns : kGravity, turns);
    // Of a motion to and fro half a period later is the opposite: the shorter delay is likelier.
    const double prior = k == 0 ? 0.0 : delayed - kStep * std::abs(k) / kUsual;
    const double likely = -0.5 * turns * elementary::log(std::max(fit.left, 1e-12)) + prior;
    if (likely <= most) continue;
    most = likely;
    // A drive has no drag or inertia below zero: without the term it leaves as much more.
    const double left = std::max(fit.left, 1e-12);
    const double against = 0.5 * turns * elementary::log((left + fit.more) / left);
    sense = against + reaction > 0.0 ? fit.sense : 1.0;
  }
  return sense;
}

}  // namespace dcnn
