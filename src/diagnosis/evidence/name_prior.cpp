// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/name_prior.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "diagnosis/candidates.h"
#include "diagnosis/evidence/marginal.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/judgement.h"
#include "diagnosis/member.h"

namespace dcnn::evidence {
namespace {

/// ln of the surface of the unit sphere in d dimensions, S_d = 2 pi S_(d-2)/(d - 2); of one that
/// only resists, of its positive part.
double log_sphere(Index d, bool one_sided) {
  double surface = d % 2 == 1 ? 2.0 : 2.0 * std::numbers::pi;
  for (Index n = d % 2 == 1 ? 3 : 4; n <= d; n += 2) {
    surface *= 2.0 * std::numbers::pi / static_cast<double>(n - 2);
  }
  return elementary::log(surface) -
         (one_sided ? static_cast<double>(d) * elementary::log(2.0) : 0.0);
}

/// ln of n C(n, k): of how many ways k of n numbers are one, each count as likely as another.
double log_choices(Index n, Index k) {
  double sum = elementary::log(static_cast<double>(n));
  for (Index i = 1; i <= k; ++i) {
    sum +=
        elementary::log(static_cast<double>(n - k + i)) - elementary::log(static_cast<double>(i));
  }
  return sum;
}

/// ln of what the prior of a force sensor's calibration leaves of that of any size, where the
/// amplitudes are shares of what it reads. (A machine's gain is the unit of its simulator.)
double log_calibration(const Setting& setting, const Member& member) {
  if (setting.study.axis || member.kind->stage != Stage::kSensor) return 0.0;
  const Json parameters = parameters_of(member);
  for (const auto& [name, value] : parameters.items()) {
    if (!unit_of_parameter(name).empty()) return 0.0;
  }
  return -0.5 * member.amplitudes.squaredNorm() / (prior::kCalibration * prior::kCalibration);
}

}  // namespace

double log_odds_of_name(const Case& study, const EffectKind& kind) {
  const double name = study.axis && kind.common ? prior::kCommon : prior::kName;
  return elementary::log(name / (1.0 - name)) +
         (kind.special ? elementary::log(prior::kSpecial) : 0.0);
}

double log_prior(const Setting& setting, const JointFit& fit, std::size_t m) {
  const Member& member = fit.members[m];
  const auto axes = std::max<std::size_t>(1, axes_of(setting.study, *member.kind).size());
  double sum = log_odds_of_name(setting.study, *member.kind) - elementary::log(double(axes));
  if (member.interval_s) {
    const double edges = member.kind->interval == IntervalRule::kRequired ? 2.0 : 1.0;
    sum += edges * elementary::log(prior::kEdge / std::max(1.0, span_seconds(setting.study)));
  }
  const auto [first, count] = tangent_columns(fit, m);
  if (count == 0) return sum;
  const Eigen::MatrixXd own = fit.tangent.middleCols(first, member.amplitudes.size());
  std::vector<Index> open;  // amplitudes that are not held at zero
  Index measured = 0;       // those that change any reading: of a force on one axis one of three
  for (Index i = 0; i < member.amplitudes.size(); ++i) {
    if (own.col(i).isZero(0.0)) continue;
    ++measured;
    if (!member.is_held(i)) open.push_back(i);
  }
  sum += log_calibration(setting, member);
  if (member.form->special) sum += elementary::log(prior::kSpecial);
  const auto d = static_cast<Index>(open.size());
  // Which of the entries act: any number of them alike, and any choice of so many.
  if (!member.held.empty()) sum -= log_choices(measured, d);
  if (d > 0) {
    const Eigen::MatrixXd columns = own(Eigen::all, open);
    const Eigen::MatrixXd gram = columns.transpose() * columns;
    const double norm = std::sqrt(std::max(1.0, (own * member.amplitudes).squaredNorm()));
    Linear metric{gram, Eigen::VectorXd::Zero(d), 0.0, Eigen::VectorXd::Zero(d)};
    sum +=
        0.5 * log_determinant(metric) - elementary::log(prior::kDecades * elementary::log(10.0)) -
        static_cast<double>(d) * elementary::log(norm) - log_sphere(d, member.form->non_negative);
  }
  for (Index i = 0; i < member.shapes.size(); ++i) {
    const ShapeParameter& shape = member.shape(i);
    sum -= elementary::log(search_scale(shape, shape.high) - search_scale(shape, shape.low));
  }
  return sum;
}

}  // namespace dcnn::evidence
