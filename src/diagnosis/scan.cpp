// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/scan.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/beginning.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/passed_base.h"

namespace dcnn {
namespace {

constexpr double kUnit =
    1e-3;  // amplitude of a column: small enough for angles, large for rounding

/// Whether a member's amplitudes are those of its effect.
bool is_itself(const Case& study, const Member& member) {
  const Eigen::VectorXd& a = member.amplitudes;
  if (!study.axis && a.size() > 1 && std::abs(a(1)) > member.form->most_ratio * std::abs(a(0))) {
    return false;
  }
  const auto of_kind = member.kind->is_itself;
  return of_kind == nullptr || of_kind(a, study.axis != nullptr);
}

}  // namespace

double least_gain(const Setting& setting, int numbers, bool alone) {
  if (setting.study.axis) return (prior::kTriedOnMachine + numbers) * setting.price;
  if (!alone || numbers == 0) return (prior::kTried + numbers) * setting.price;
  return (prior::kTried + prior::kFirstNumber + prior::kFurtherNumber * (numbers - 1)) *
         setting.price;
}

Scan::Scan(const Setting& setting, const JointFit& fit)
    : setting_(setting),
      chain_(setting.study, fit.members),
      coarse_chain_(setting.coarse, fit.members),
      here_(setting.whitened(chain_.prediction())),
      coarse_here_(setting.coarse_whitener(coarse_chain_.prediction()).cwiseProduct(setting.mask)),
      tangent_(setting.study.without.projection ? setting.nuisance : fit.tangent),
      first_of_base_(setting.study.without.projection ? 0 : fit.free_parameters()),
      basis_(orthonormal(tangent_)) {
  residual_ = off_model(fit.residual);
  force_rows_ = rows_of_forces(setting.study, setting.whitener);
}

bool Scan::is_possible(const Member& member) const {
  // Beside the same law undriven, amplitudes tell how its strength changes and not what it is.
  const bool changes = std::any_of(chain_.members().begin(), chain_.members().end(),
                                   [&](const Member& m) { return is_undriven(m, member); });
  if (changes) return true;
  const auto is_bounded = [&](double a) { return member.form->bounded(a) == a; };
  const bool bounded = std::all_of(member.amplitudes.begin(), member.amplitudes.end(), is_bounded);
  return bounded && is_itself(setting_.study, member);
}

Eigen::MatrixXd Scan::off_model(const Eigen::MatrixXd& columns) const {
  return off_basis(columns, basis_);
}

Eigen::VectorXd Scan::added(const Member& member, Detail detail) const {
  if (detail == Detail::kFine) return setting_.whitened(chain_.with(member)) - here_;
  const Signals signals = coarse_chain_.with(member);
  return setting_.coarse_whitener(signals).cwiseProduct(setting_.mask) - coarse_here_;
}

Eigen::MatrixXd Scan::columns(const Member& member, Detail detail) const {
  Member unit = member;
  if (member.amplitudes.size() == 0) return added(unit, detail);
  Eigen::MatrixXd columns(here_.size(), member.amplitudes.size());
  // From a common point with all amplitudes alike, since some laws divide by one of them.
  const bool needs_origin = member.amplitudes.size() == 2;
  Eigen::VectorXd origin = Eigen::VectorXd::Zero(here_.size());
  if (needs_origin) {
    unit.amplitudes.setConstant(kUnit);
    origin = added(unit, detail);
  }
  for (Index j = 0; j < columns.cols(); ++j) {
    unit.amplitudes.setConstant(needs_origin ? kUnit : 0.0);
    unit.amplitudes(j) += kUnit;
    columns.col(j) = (added(unit, detail) - origin) / kUnit;
  }
  return columns;
}

Trial Scan::evaluate(const Member& member, Detail detail) const {
  Trial trial;
  trial.member = member;
  trial.price = setting_.price;
  const bool lag = member.kind->stage == Stage::kDynamics && member.amplitudes.size() == 0;
  if (lag && !setting_.study.logs.front().regressors.empty()) {
    if (!is_itself(setting_.study, member)) return trial;
    trial.gain =
        std::max(0.0, residual_.squaredNorm() -
                          left_beside_base(setting_, chain_, tangent_, first_of_base_, member));
    return trial;
  }
  const Eigen::MatrixXd raw = columns(member, detail);
  Eigen::MatrixXd c = off_model(raw);
  const double energy = raw.squaredNorm();
  trial.kept = energy > 0.0 ? c.squaredNorm() / energy : 0.0;
  // Of a law that divides by its strength, as a spring's rest is, the strength must be its own.
  if (c.cols() == 2 && c.col(0).isZero(0.0)) return trial;
  const Eigen::MatrixXd begun = orthonormal(off_model(beginnings(setting_, member, detail)));
  if (begun.cols() > 0) c -= begun * (begun.transpose() * c);
  const Eigen::VectorXd match = c.transpose() * residual_;
  if (member.amplitudes.size() == 0) {
    trial.gain = std::max(0.0, 2.0 * match(0) - c.squaredNorm());
    return trial;
  }
  trial.member.amplitudes = least_squares(c, residual_);
  const Eigen::MatrixXd gram = c.transpose() * c;
  trial.deviation =
      gram.diagonal().unaryExpr([](double g) { return g > 0.0 ? 1.0 / std::sqrt(g) : 0.0; });
  if (!trial.member.amplitudes.allFinite()) return trial;
  if (member.levers() > 0) fit_lever(c, begun, detail, trial);
  if (trial.gain > 0.0 || !is_possible(trial.member)) return trial;
  trial.gain = std::max(0.0, match.dot(trial.member.amplitudes));
  return trial;
}

std::optional<double> Scan::least_detectable(const Member& member) const {
  constexpr double kTestable = 0.002;  // share of the energy that must be its own
  constexpr double kPower = 1.28;      // of a normal at 90 %
  const Eigen::MatrixXd raw = columns(member, Detail::kCoarse), own = off_model(raw);
  Index best = 0;
  own.colwise().squaredNorm().maxCoeff(&best);
  const double energy = own.col(best).squaredNorm();
  if (!(energy > kTestable * raw.col(best).squaredNorm()) || energy == 0.0) return std::nullopt;
  const double needed =
      std::sqrt(least_gain(setting_, member.parameters(), chain_.members().empty())) + kPower;
  Member unit = member;
  double scale = 1.0;
  if (member.amplitudes.size() > 0) {
    unit.amplitudes.setConstant(member.amplitudes.size() == 2 ? kUnit : 0.0);
    unit.amplitudes(best) += kUnit;
    scale = kUnit;
  }
  double most = 0.0;
  const Signals with = coarse_chain_.with(unit), &without = coarse_chain_.prediction();
  for (Index j = 0; j < setting_.study.channel_count(); ++j) {
    double square = 0.0, count = 0.0;
    for (std::size_t k = 0; k < with.size(); ++k) {
      square += (with[k].col(j) - without[k].col(j)).squaredNorm();
      count += static_cast<double>(with[k].rows());
    }
    most = std::max(most, std::sqrt(square / count));
  }
  return most / scale * needed / std::sqrt(energy);
}

Trial Scan::refine(const Trial& start, Detail detail, int evaluations) const {
  if (start.member.own_shapes() == 0 || setting_.study.without.refinement) return start;
  return improved(start, detail, evaluations);
}

Trial Scan::improved(const Trial& start, Detail detail, int evaluations,
                     std::vector<Trial>* seen) const {
  const Index n = start.member.own_shapes();
  Eigen::VectorXd x(n), size(n);
  for (Index i = 0; i < n; ++i) {
    const ShapeParameter& shape = start.member.shape(i);
    x(i) = search_scale(shape, start.member.shapes(i));
    size(i) = shape.low > 0.0 ? 0.4 : 0.15 * (shape.high - shape.low);
    if (detail == Detail::kFine) size(i) *= 0.2;
    if (shape.peak == ShapeParameter::Peak::kNarrow) {
      size(i) = start.member.kind->stage == Stage::kResonance ? 0.05 : 0.01;
    }
    if (shape.peak == ShapeParameter::Peak::kLine) {
      size(i) = 0.1 / (span_seconds(setting_.study) * start.member.shapes(i));
    }
    if (start.member.driver && i == n - 1) size(i) = 0.02 + 0.2 * std::abs(start.member.shapes(i));
  }
  Trial best = start;
  const auto loss = [&](const Eigen::VectorXd& at) {
    Member member = start.member;
    for (Index i = 0; i < n; ++i) {
      member.shapes(i) = from_search_scale(member, i, at(i));
    }
    const Trial trial = evaluate(member, detail);
    if (trial.gain > best.gain) best = trial;
    if (seen) seen->push_back(trial);
    return -trial.gain;
  };
  simplex_search(loss, x, size, n == 1 ? evaluations * 2 / 3 : evaluations);
  return best;
}

}  // namespace dcnn
