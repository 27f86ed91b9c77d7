// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "diagnosis/judgement.h"

namespace dcnn::evidence {
namespace {

constexpr double kAtBound = 1e-3;  // of a range's larger end: tolerance
constexpr double kHeld = 1e12;     // precision over a column's square

/// 1 at the upper bound, -1 at the lower one, else 0.
double side_of(const Member& member, Index shape) {
  const double least = member.least_shapes(shape), most = member.most_shapes(shape);
  if (!(most > least)) return 0.0;  // held as it is
  const double value = member.shapes(shape);
  const double large = kAtBound * std::max(std::abs(most), std::abs(least));
  if (value > most - large) return 1.0;
  const bool logarithmic = member.shape(shape).low > 0.0;
  return value < least + (logarithmic ? kAtBound * least : large) ? -1.0 : 0.0;
}

double side_of(const EffectFit& form, double amplitude) {
  if (form.non_negative && amplitude <= 0.0) return -1.0;
  if (std::abs(amplitude) < form.most_strength) return 0.0;
  return amplitude > 0.0 ? 1.0 : -1.0;
}

}  // namespace

double hold_at_bounds(const JointFit& fit, Eigen::VectorXd& precision) {
  double widths = 0.0;
  const auto hold = [&](Index column, double side) {
    const double slope = side * fit.tangent.col(column).dot(fit.residual);
    const double curvature = fit.tangent.col(column).squaredNorm();
    if (side == 0.0 || slope <= 0.0 || curvature <= 0.0) return;
    precision(column) = kHeld * curvature;
    const double root = std::sqrt(slope * slope + 8.0 * curvature / std::numbers::pi);
    widths += elementary::log(2.0 / (slope + root));
  };
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    const Member& member = fit.members[m];
    const auto [first, count] = tangent_columns(fit, m);
    if (count == 0) continue;
    const Index strengths = member.amplitudes.size();
    for (Index i = 0; i < strengths; ++i) {
      hold(first + i, side_of(*member.form, member.amplitudes(i)));
    }
    for (Index i = 0; i < member.shapes.size(); ++i) {
      hold(first + strengths + i, side_of(member, i));
    }
  }
  return widths;
}

}  // namespace dcnn::evidence
