// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

constexpr Eigen::Index kFirstRows = 10;

/// A sensor that was zeroed before the recording, in whatever pose, has an offset of the size of
/// the tool's weight: |b| = m g, within what the fit tells of both. Against offsets of any size,
/// whose median is kOffset.
std::vector<Fault> find_zeroed_before(const Evidence& e) {
  const Adopted& a = e.adopted;
  const double g = e.log.declared.model ? e.log.declared.model->gravity.norm() : kEarthGravity;
  const double offset = a.fit.bias.norm();
  if (offset <= 0.0) return {};
  Eigen::Matrix<double, 7, 1> slope = Eigen::Matrix<double, 7, 1>::Zero();
  slope[0] = -g;
  slope.tail<3>() = a.fit.bias / offset;
  const RigidFit& fit = a.beside_friction;
  // What physics beyond the tool leaves is alike for seconds.
  const double scale = static_cast<double>(fit.residual.size()) /
                       std::min(kMostIndependent, independent_of(fit.residual));
  const double variance = std::max(1.0, scale) * slope.dot(fit.covariance * slope);
  const double off = fit.bias.norm() - g * fit.mass;
  if (!(variance > 0.0)) return {};
  // ln of densities per newton, both but for ln sqrt(2 pi): of |b| - m g, and of log-normal sizes.
  const double zeroed = -0.5 * off * off / variance - 0.5 * elementary::log(variance);
  const double spread = offset < kOffset.median ? kOffset.below : kOffset.above;
  const double any = plausibility(offset, kOffset) - elementary::log(spread * offset);
  const double log_odds = log_odds_of(kZeroedBefore) + zeroed - any;
  return {fault_of(zeroed_fault, probability_of_log_odds(log_odds), "fx",
                   "the offset of " + brief(fit.bias.norm()) +
                       " N is as large as the tool's weight: the sensor was zeroed in another pose "
                       "before, its offset is this recording's own")};
}

/// The first rows of a sensor that is zeroed when the recording begins read nothing but noise,
/// though the tool has a weight. By chance so near to zero: the share of the ball that the force is
/// in.
std::vector<Fault> find_zeroed_first(const Evidence& e) {
  const Adopted& a = e.adopted;
  if (!e.log.smooth || e.log.rows() < 10 * kFirstRows) return {};
  const Eigen::MatrixXd F = e.log.block({"fx", "fy", "fz"});
  const Eigen::Vector3d first = F.topRows(kFirstRows).colwise().mean();
  double noise = 0.0;
  for (Eigen::Index j = 0; j < 3; ++j) noise += std::pow(noise_of(F.col(j)), 2);
  noise = std::sqrt(noise / static_cast<double>(kFirstRows));
  const double size = std::sqrt(F.squaredNorm() / static_cast<double>(F.rows()));
  const double weight = a.reading.force > 0.0 ? kEarthGravity * a.fit.mass / a.reading.force : 0.0;
  if (size <= 0.0 || weight < 10.0 * noise) return {};
  const double near = std::max(first.norm(), noise) / size;
  const double probability = posterior_of_p(std::min(1.0, near * near * near));
  if (probability < kLikely) return {};
  return {
      fault_of(zeroed_fault, probability, "fx",
               "the force begins at zero (" + brief(first.norm()) + " within " + brief(size) +
                   "): the sensor was zeroed at the start, its offset is this recording's own")};
}

std::vector<Fault> find_zeroed(const Evidence& e) {
  // A force without its weight begins near zero anyway.
  const bool weightless = e.log.declared.read.payload.mass > 0.0 || e.adopted.reading.compensated;
  if (weightless || !e.adopted.compared || e.adopted.fit.mass <= 0.0) return {};
  const std::vector<Fault> first = find_zeroed_first(e);
  return first.empty() ? find_zeroed_before(e) : first;
}

}  // namespace

const FaultKind zeroed_fault{"zeroed", false,
                             "do not carry the offset from one recording to another; dcnn-diagnose "
                             "--zeroed estimates one for each",
                             "", find_zeroed};

}  // namespace dcnn::check
