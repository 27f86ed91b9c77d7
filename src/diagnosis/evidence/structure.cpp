// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/structure.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/linear_algebra.h"
#include "diagnosis/beginning.h"
#include "diagnosis/candidates.h"
#include "diagnosis/evidence/bounds.h"
#include "diagnosis/evidence/few_rows.h"
#include "diagnosis/evidence/marginal.h"
#include "diagnosis/evidence/name_prior.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/judgement.h"
#include "diagnosis/member.h"

namespace dcnn::evidence {
namespace {

constexpr std::size_t kMostFields = 4, kTriedAgain = 30;

/// Precisions of the priors of a fit's linear columns: free parameters, those of a base simulator
/// that is fitted and the offsets of zeroed recordings are flat.
Eigen::VectorXd precisions(const Setting& setting, const JointFit& fit) {
  Eigen::VectorXd precision = Eigen::VectorXd::Zero(fit.tangent.cols());
  const Index first = fit.free_parameters() + setting.flat_columns();
  const Index errors = setting.study.logs.front().base_errors.cols();
  const Index smoothing = setting.nuisance.cols() - setting.flat_columns() - errors;
  precision.segment(first, errors).setOnes();
  precision.segment(first + errors, smoothing)
      .setConstant(1.0 / (prior::kFiltering * prior::kFiltering));
  Index column = first + errors + smoothing;
  const auto logs = static_cast<Index>(setting.study.logs.size());
  for (const Member& member : fit.members) {
    if (!begins_anywhere(setting.study, member) || column + logs > precision.size()) continue;
    const double sd = prior::kBeginning * std::max(1e-12, std::abs(member.amplitudes(0)));
    precision.segment(column, logs).setConstant(1.0 / (sd * sd));
    column += logs;
  }
  return precision;
}

/// What each member adds, times slowly varying quantities: how a law that is nearly right errs.
Eigen::MatrixXd model_errors(const Grid& grid, const std::vector<Member>& members) {
  const Case& study = grid.study();
  std::vector<Eigen::VectorXd> columns;
  const Chain chain(study, members);
  for (std::size_t m = 0; m < members.size(); ++m) {
    const bool exact = members[m].parameters() == 0 || members[m].kind->is_constant;
    if (members[m].fixed || (exact && !members[m].driver)) continue;
    std::vector<Member> rest = members;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(m));
    const Signals without = predict(study, rest);
    const auto add = [&](const auto& modulator) {
      Signals signals;
      for (std::size_t k = 0; k < without.size(); ++k) {
        const Eigen::VectorXd u = modulator(k);
        const double low = u.minCoeff(), high = u.maxCoeff();
        const Eigen::ArrayXd even = high > low
                                        ? ((2.0 * u.array() - high - low) / (high - low)).eval()
                                        : Eigen::ArrayXd::Ones(u.size()).eval();
        signals.emplace_back((prior::kModelError * even).matrix().asDiagonal() *
                             (chain.prediction()[k] - without[k]));
      }
      columns.push_back(grid(signals));
    };
    const auto motion = [&](std::size_t k) -> const Motion& { return study.logs[k].motion; };
    add([&](std::size_t k) -> Eigen::VectorXd { return motion(k).t; });
    for (Index a = 0; a < 3; ++a) {
      add([&](std::size_t k) -> Eigen::VectorXd { return motion(k).euler.col(a); });
    }
    add([&](std::size_t k) -> Eigen::VectorXd { return motion(k).w_S.rowwise().norm(); });
    if (motion(0).v_B.rows() == motion(0).samples()) {
      add([&](std::size_t k) -> Eigen::VectorXd { return motion(k).v_B.rowwise().norm(); });
    }
  }
  Eigen::MatrixXd all(grid.rows(), static_cast<Index>(columns.size()));
  for (Index k = 0; k < all.cols(); ++k) all.col(k) = columns[static_cast<std::size_t>(k)];
  return all;
}

/// Whether a field acts along the axis of a named effect.
bool shares_axis(const Field& field, const std::vector<Member>& members) {
  return std::any_of(members.begin(), members.end(), [&](const Member& m) {
    if (m.axis.empty()) return false;
    std::string axis = m.axis.substr(m.axis.find(':') + 1);
    if (axis == "tool_z") axis = "sensor_z";
    return axis == field.axis;
  });
}

/// Columns whose Gaussian priors have unit variance, and flat ones, projected out of fields.
class Background {
 public:
  Background(const Grid& grid, Eigen::MatrixXd X, Eigen::VectorXd precision, Eigen::VectorXd y)
      : X_(std::move(X)), precision_(std::move(precision)), y_(std::move(y)) {
    at_rest_ = grid.study().is_static();
    update();
  }
  void extend(const Eigen::MatrixXd& columns) {
    X_ = appended(X_, columns);
    const Index before = precision_.size();
    precision_.conservativeResize(X_.cols());
    precision_.tail(X_.cols() - before).setOnes();
    update();
  }
  double log_factor(const Field& field, double* tau) const {
    const Eigen::MatrixXd& P = field.columns;
    Eigen::MatrixXd gram = P.transpose() * P;
    Eigen::VectorXd match = P.transpose() * y_;
    if (X_.cols() > 0) {
      const Eigen::MatrixXd cross = half_ * (X_.transpose() * P);
      gram -= cross.transpose() * cross;
      match -= cross.transpose() * match_;
    }
    if (!at_rest_) return log_field(gram, match, prior::kLeastField, prior::kMostField, tau);
    return log_student_field(gram, match, square_, freedom_, prior::kLeastField, prior::kMostField,
                             tau);
  }
  /// ln p(y): of rows in time with noise of unit variance.
  double log_probability() const {
    const Linear model = linear_model(X_, y_, precision_);
    if (at_rest_) return log_student_evidence(model, static_cast<double>(y_.size()));
    return log_evidence(model) - 0.5 * y_.squaredNorm();
  }

 private:
  void update() {
    if (at_rest_) {
      const Linear model = linear_model(X_, y_, precision_);
      square_ = least_square(model);
      freedom_ = freedom_of(model, static_cast<double>(y_.size()));
    }
    if (X_.cols() == 0) return;
    Eigen::MatrixXd A = X_.transpose() * X_;
    A.diagonal() += precision_;
    const double ridge = 1e-10;
    for (Index k = 0; k < A.rows(); ++k) A(k, k) += ridge * A(k, k) + 1e-280;
    const Eigen::VectorXd scale = A.diagonal().cwiseSqrt().cwiseInverse();
    half_ = inverse_cholesky(scale.asDiagonal() * A * scale.asDiagonal()) * scale.asDiagonal();
    match_ = half_ * (X_.transpose() * y_);
  }
  Eigen::MatrixXd X_;
  Eigen::VectorXd precision_, y_;
  Eigen::MatrixXd half_;   // inverse of the Cholesky factor of X'X + P
  Eigen::VectorXd match_;  // half_ X'y
  bool at_rest_ = false;
  double square_ = 0.0, freedom_ = 0.0;  // there: what X leaves of y
};

/// Fields one after the other, as long as they gain more than their choice costs.
Unknown unknown_beside(const Grid& grid, const std::vector<Member>& members,
                       Background background) {
  const std::vector<Field> all = fields(grid, predict(grid.study(), members));
  Unknown unknown;
  const double choice = elementary::log(static_cast<double>(std::max<std::size_t>(1, all.size())));
  std::vector<double> factors(all.size()), taus(all.size());
  const auto evaluate = [&](std::size_t k) {
    factors[k] = background.log_factor(all[k], &taus[k]) - choice;
    if (shares_axis(all[k], members)) factors[k] -= prior::kSameCause;
  };
  for_each_piece(static_cast<Index>(all.size()), [&](Index k) { evaluate(std::size_t(k)); });
  unknown.log_factor = log_sum(factors);
  std::vector<std::size_t> order(all.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto sort = [&] {
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return factors[a] > factors[b]; });
  };
  sort();
  double sum = unknown.log_factor;
  for (std::size_t term = 0; term < kMostFields && !order.empty(); ++term) {
    const std::size_t best = order.front();
    if (factors[best] <= 0.0) break;
    if (term == 0) unknown.gain = factors[best];
    if (term > 0) sum += factors[best], unknown.gain += factors[best];
    unknown.words.push_back(all[best].driver + ", along " + all[best].axis);
    background.extend(taus[best] * all[best].columns);
    order.erase(order.begin());
    if (order.size() > kTriedAgain) order.resize(kTriedAgain);
    for_each_piece(static_cast<Index>(order.size()),
                   [&](Index k) { evaluate(order[static_cast<std::size_t>(k)]); });
    sort();
  }
  unknown.log_factor = sum;
  return unknown;
}

/// ln p(recordings, members) and what it leaves as a background of fields.
struct NamedEvidence {
  double logarithm = 0.0;
  double errors = 0.0;  ///< of it, what the laws' relative errors explain
  Background background;
};

NamedEvidence named_evidence(const Setting& setting, const Grid& grid, const JointFit& fit) {
  Eigen::VectorXd precision = precisions(setting, fit);
  const double widths = hold_at_bounds(fit, precision);
  // The residual with what the nuisance columns took off put back.
  const Eigen::VectorXd target =
      fit.residual + fit.tangent.rightCols(fit.nuisance.size()) * fit.nuisance;
  Background background(grid, grid.pooled(fit.tangent), precision, grid.pooled(target));
  const double pooled = background.log_probability();
  double sum = widths + (grid.study().is_static()
                             ? pooled
                             : log_evidence(linear_model(fit.tangent, target, precision)) -
                                   0.5 * target.squaredNorm());
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    if (!fit.members[m].fixed) sum += log_prior(setting, fit, m);
  }
  const Eigen::MatrixXd errors = model_errors(grid, fit.members);
  double explained = 0.0;
  if (errors.cols() > 0) {
    background.extend(errors);
    explained = std::max(0.0, background.log_probability() - pooled);
  }
  return {sum + explained, explained, std::move(background)};
}

}  // namespace

double log_named_of(const Setting& setting, const Grid& grid, const JointFit& fit) {
  return named_evidence(setting, grid, fit).logarithm;
}

Structure structure_of(const Setting& setting, const Grid& grid, const JointFit& fit) {
  NamedEvidence named = named_evidence(setting, grid, fit);
  Structure structure;
  structure.members = fit.members;
  structure.chi2 = fit.chi2;
  structure.log_named = named.logarithm;
  structure.noise = slow_noise(grid, grid.pooled(fit.residual));
  // Of the whole residual: in place of the laws' errors, not beside them.
  structure.noise.log_factor -= named.errors;
  structure.unknown = unknown_beside(grid, fit.members, std::move(named.background));
  return structure;
}

}  // namespace dcnn::evidence
