#include "diagnosis/gear_order.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/elementary.h"
#include "core/linear_algebra.h"
#include "diagnosis/candidates.h"

namespace dcnn {
namespace {

constexpr double kStill = 0.05;        // of the rms velocity: below it friction has no sign
constexpr double kLargestPhase = 0.5;  // rad, of an order, from one bin to the next
constexpr Index kFewestGearBins = 16;

/// What is left against the motion, in bins of the position.
struct GearBins {
  double low = 0.0, high = 0.0, width = 0.0;
  Eigen::VectorXd sum, count;
};

GearBins gear_bins(const Case& study, const Signals& left) {
  GearBins bins{1e300, -1e300, 0.0, {}, {}};
  double square = 0.0, samples = 0.0;
  for (const Log& log : study.logs) {
    bins.low = std::min(bins.low, log.motion.euler.col(0).minCoeff());
    bins.high = std::max(bins.high, log.motion.euler.col(0).maxCoeff());
    square += log.motion.v_B.col(0).squaredNorm();
    samples += static_cast<double>(log.motion.samples());
  }
  const double still = kStill * std::sqrt(square / samples);
  bins.width = (bins.high - bins.low) / kPositionBins;
  const auto size = static_cast<Index>((bins.high - bins.low) / bins.width) + 1;
  bins.sum = bins.count = Eigen::VectorXd::Zero(size);
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const Motion& motion = study.logs[k].motion;
    for (Index i = 0; i < motion.samples(); i += 3) {
      const double v = motion.v_B(i, 0);
      if (std::abs(v) <= still) continue;
      const auto bin = static_cast<Index>((motion.euler(i, 0) - bins.low) / bins.width);
      bins.sum(bin) += std::copysign(1.0, v) * left[k](i, 0);
      bins.count(bin) += 1.0;
    }
  }
  return bins;
}

/// What a sine and a cosine of this order explain beside a constant.
double order_gain(const GearBins& bins, double order) {
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  std::complex<double> wave = elementary::polar(1.0, order * (bins.low + 0.5 * bins.width));
  const std::complex<double> turn = elementary::polar(1.0, order * bins.width);
  for (Index k = 0; k < bins.sum.size(); ++k, wave *= turn) {
    const Eigen::Vector3d row(1.0, wave.imag(), wave.real());
    gram += bins.count(k) * row * row.transpose();
    b += bins.sum(k) * row;
  }
  gram.diagonal().array() += 1e-9 * gram.diagonal().maxCoeff();
  return b.dot(solve_symmetric(gram, b).col(0));
}

}  // namespace

double highest_order(const Case& study, const ShapeParameter& order, double width) {
  const double told = kLargestPhase / width;
  return study.axis ? told : std::min(order.high, told);
}

void add_gear_frictions(const Case& study, const Signals& left, std::vector<Member>& list) {
  const EffectKind& kind = *find_effect("gear_friction");
  if (!is_listed(study, kind) || !is_testable(study, kind)) return;
  if (study.logs.front().motion.v_B.rows() == 0) return;
  const GearBins bins = gear_bins(study, left);
  if (bins.sum.size() < kFewestGearBins || !(bins.count.maxCoeff() > 0.0)) return;
  const double range = bins.high - bins.low, least = kFewestTurns * 2.0 * std::numbers::pi / range;
  const EffectFit& form = kind.fits[0];
  double best = 0.0, most = -1.0;
  const double step = 0.4 / range, end = highest_order(study, form.shapes[0], bins.width);
  for (double order = std::max(least, unit_of(study, form.shapes[0]) * form.shapes[0].low);
       order < end; order += step) {
    const double gain = order_gain(bins, order);
    if (gain > most) most = gain, best = order;
  }
  if (best == 0.0) return;
  for (const double v0 : form.shapes[1].seeds) {
    list.push_back(make_member(study, kind, form, axes_of(study, kind).front(),
                               Eigen::Vector2d(best, unit_of(study, form.shapes[1]) * v0)));
    list.back().least_shapes(0) = least;
    list.back().most_shapes(0) = end;
  }
}

}  // namespace dcnn
