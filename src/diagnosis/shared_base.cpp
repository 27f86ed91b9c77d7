#include "diagnosis/shared_base.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/elementary.h"
#include "core/linear_algebra.h"
#include "dcnn/data/filter.h"
#include "dcnn/physics/arm.h"
#include "dcnn/physics/axis_machine.h"
#include "diagnosis/axis_case.h"
#include "diagnosis/holdout.h"

namespace dcnn {
namespace {

constexpr Index kSharedPieces = 6;
constexpr Index kFriction = 5;  // columns: offset, viscous, and dry friction of three widths
constexpr double kSharedBaseRidge = 1e-9;
constexpr double kDryWidths[] = {0.02, 0.1, 0.4};  // of the rms velocity, in which friction turns
constexpr int kReweightings = 4;
constexpr double kSharedTolerance = 1e-3;  // of a column's length that others must leave

/// Rows of one joint: columns of the arm, its friction, what was measured, and the piece of time.
struct JointRows {
  Eigen::MatrixXd arm, friction;
  Eigen::VectorXd measured;
  std::vector<Index> piece;
};

bool is_held(const std::vector<Span>& spans, std::size_t log, double t) {
  return std::any_of(spans.begin(), spans.end(),
                     [&](const Span& s) { return s.log == log && t >= s.begin && t <= s.end; });
}

Eigen::MatrixXd friction_columns(const Motion& motion) {
  const Eigen::ArrayXd v = motion.v_B.col(0).array();
  const double size = std::sqrt(v.square().mean());
  Eigen::MatrixXd columns(v.size(), kFriction);
  columns.col(0).setOnes();
  columns.col(1) = v.matrix();
  Index k = 2;
  for (const double width : kDryWidths) {
    columns.col(k++) = elementary::tanh(v / std::max(1e-12, width * size)).matrix();
  }
  return columns;
}

JointRows rows_of(const Case& study, const std::vector<Span>& held) {
  const AxisPlan& plan = *study.axis;
  JointRows all;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const Log& log = study.logs[k];
    const auto filtered = [&](const Eigen::MatrixXd& columns) {
      return low_pass(columns, log.recording, plan.system.lowpass_hz);
    };
    const Eigen::MatrixXd arm =
        filtered(base_columns(log.recording, plan.system, plan.index, study.derivative));
    const Eigen::MatrixXd friction = filtered(friction_columns(log.motion));
    // Two samples in a period of the fastest motion, times two.
    const Index stride = std::max<Index>(1, std::llround(0.25 / study.motion_hz / study.dt()));
    std::vector<Index> kept;
    const double first = log.motion.t(0);
    const double span = std::max(1e-300, log.motion.t(log.motion.samples() - 1) - first);
    for (Index i = 0; i < arm.rows(); i += stride) {
      const double t = log.motion.t(i);
      if (is_held(held, k, t)) continue;
      kept.push_back(i);
      const auto piece = static_cast<Index>(kSharedPieces * (t - first) / span);
      all.piece.push_back(static_cast<Index>(k) * kSharedPieces +
                          std::min(kSharedPieces - 1, piece));
    }
    const Index before = all.arm.rows(), more = static_cast<Index>(kept.size());
    all.arm.conservativeResize(before + more, arm.cols());
    all.friction.conservativeResize(before + more, kFriction);
    all.measured.conservativeResize(before + more);
    all.arm.bottomRows(more) = plan.sense * arm(kept, Eigen::all);
    all.friction.bottomRows(more) = friction(kept, Eigen::all);
    all.measured.tail(more) = -plan.sense * log.measured(kept, 0);
  }
  return all;
}

/// Sums of products of columns and target over each piece of time.
struct PieceSums {
  std::vector<Eigen::MatrixXd> gram;
  std::vector<Eigen::VectorXd> match;
  std::vector<double> square;
};

PieceSums sums_of(const Eigen::MatrixXd& A, const JointRows& rows, Index pieces) {
  PieceSums sums;
  for (Index p = 0; p < pieces; ++p) {
    std::vector<Index> list;
    for (std::size_t i = 0; i < rows.piece.size(); ++i) {
      if (rows.piece[i] == p) list.push_back(static_cast<Index>(i));
    }
    const Eigen::MatrixXd part = A(list, Eigen::all);
    const Eigen::VectorXd y = rows.measured(list);
    sums.gram.push_back(part.transpose() * part);
    sums.match.push_back(part.transpose() * y);
    sums.square.push_back(y.squaredNorm());
  }
  return sums;
}

double misfit(const PieceSums& sums, Index piece, const Eigen::VectorXd& c) {
  const auto p = static_cast<std::size_t>(piece);
  return sums.square[p] - 2.0 * c.dot(sums.match[p]) + c.dot(sums.gram[p] * c);
}

/// All joints in one system of equations: the arm's parameters, then each joint's friction.
class ArmSums {
 public:
  ArmSums(const std::vector<JointRows>& joints, std::vector<Index> columns)
      : columns_(std::move(columns)), variance_(joints.size(), 1.0) {
    for (const JointRows& rows : joints) {
      for (const Index p : rows.piece) pieces_ = std::max(pieces_, p + 1);
    }
    for (const JointRows& rows : joints) {
      Eigen::MatrixXd A(rows.arm.rows(), base() + kFriction);
      A << rows.arm(Eigen::all, columns_), rows.friction;
      sums_.push_back(sums_of(A, rows, pieces_));
      rows_.push_back(static_cast<double>(rows.measured.size()));
    }
  }

  Index pieces() const { return pieces_; }
  const std::vector<Index>& columns() const { return columns_; }

  /// Coefficients fitted to all pieces but one (-1: to all).
  Eigen::VectorXd fit(Index left_out) const {
    const Index size = base() + kFriction * static_cast<Index>(sums_.size());
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd match = Eigen::VectorXd::Zero(size);
    for (std::size_t j = 0; j < sums_.size(); ++j) {
      const std::vector<Index> own = places(j);
      for (Index p = 0; p < pieces_; ++p) {
        if (p == left_out) continue;
        gram(own, own) += sums_[j].gram[static_cast<std::size_t>(p)] / variance_[j];
        match(own) += sums_[j].match[static_cast<std::size_t>(p)] / variance_[j];
      }
    }
    return solve_gram(gram, match, kSharedBaseRidge);
  }

  /// Weights of the joints by what each leaves.
  void reweight() {
    for (int pass = 0; pass < kReweightings; ++pass) {
      const Eigen::VectorXd c = fit(-1);
      for (std::size_t j = 0; j < sums_.size(); ++j) {
        double sum = 0.0;
        for (Index p = 0; p < pieces_; ++p) sum += misfit(sums_[j], p, c(places(j)));
        variance_[j] = std::max(1e-300, sum / rows_[j]);
      }
    }
  }

  /// Misfit of each joint on pieces that were left out, with the parameters of all joints …
  std::vector<double> left_out_of_shared() const {
    std::vector<double> sums(sums_.size(), 0.0);
    for (Index p = 0; p < pieces_; ++p) {
      const Eigen::VectorXd c = fit(p);
      for (std::size_t j = 0; j < sums.size(); ++j) sums[j] += misfit(sums_[j], p, c(places(j)));
    }
    return sums;
  }
  /// … and of one joint with parameters of its own.
  double left_out_of_own(std::size_t joint) const {
    double sum = 0.0;
    for (Index p = 0; p < pieces_; ++p) sum += misfit(sums_[joint], p, own_fit(joint, p));
    return sum;
  }

 private:
  Index base() const { return static_cast<Index>(columns_.size()); }
  /// Of a joint's columns among all unknowns.
  std::vector<Index> places(std::size_t joint) const {
    std::vector<Index> list(static_cast<std::size_t>(base() + kFriction));
    for (Index k = 0; k < base(); ++k) list[static_cast<std::size_t>(k)] = k;
    for (Index k = 0; k < kFriction; ++k) {
      list[static_cast<std::size_t>(base() + k)] =
          base() + kFriction * static_cast<Index>(joint) + k;
    }
    return list;
  }
  Eigen::VectorXd own_fit(std::size_t joint, Index left_out) const {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(base() + kFriction, base() + kFriction);
    Eigen::VectorXd match = Eigen::VectorXd::Zero(base() + kFriction);
    for (Index p = 0; p < pieces_; ++p) {
      if (p == left_out) continue;
      gram += sums_[joint].gram[static_cast<std::size_t>(p)];
      match += sums_[joint].match[static_cast<std::size_t>(p)];
    }
    return solve_gram(gram, match, kSharedBaseRidge);
  }

  std::vector<Index> columns_;
  std::vector<PieceSums> sums_;
  std::vector<double> variance_, rows_;
  Index pieces_ = 0;
};

/// Columns that all joints together tell apart, each joint in units of what it measures.
std::vector<Index> columns_of(const std::vector<JointRows>& joints) {
  Eigen::MatrixXd stacked(0, joints.front().arm.cols());
  for (const JointRows& rows : joints) {
    const double size = std::max(1e-300, rows.measured.norm());
    const Index before = stacked.rows();
    stacked.conservativeResize(before + rows.arm.rows(), Eigen::NoChange);
    stacked.bottomRows(rows.arm.rows()) = rows.arm / size;
  }
  return independent_columns(stacked, kSharedTolerance);
}

void give_base(Case& study, const std::vector<Index>& columns, const Eigen::VectorXd& parameters) {
  AxisPlan plan = *study.axis;
  plan.columns = columns;
  plan.base_is_known = true;
  study.base_coefficients = plan.sense * parameters;
  study.axis = std::make_shared<const AxisPlan>(std::move(plan));
  set_axis_motion(study);
}

}  // namespace

void share_base(std::vector<LoadedCase>& cases) {
  const auto has_arm = [](const LoadedCase& loaded) {
    const AxisPlan& plan = *loaded.fit.axis;
    return !plan.system.arm.is_null() && !plan.axis().has_base && plan.axis().simulated.empty();
  };
  if (cases.size() < 2 || !std::all_of(cases.begin(), cases.end(), has_arm)) return;
  std::vector<JointRows> joints;
  for (const LoadedCase& loaded : cases) {
    const bool inside = loaded.holdout.logs.empty();
    joints.push_back(
        rows_of(loaded.fit, inside ? held_out_blocks(loaded.fit, true) : std::vector<Span>()));
  }
  ArmSums arm(joints, columns_of(joints));
  arm.reweight();
  const Eigen::VectorXd all = arm.fit(-1);
  const Eigen::VectorXd parameters = all.head(static_cast<Index>(arm.columns().size()));
  const std::vector<double> shared = arm.left_out_of_shared();
  for (std::size_t j = 0; j < cases.size(); ++j) {
    if (shared[j] > arm.left_out_of_own(j)) continue;
    give_base(cases[j].fit, arm.columns(), parameters);
    give_base(cases[j].holdout, arm.columns(), parameters);
  }
}

}  // namespace dcnn
