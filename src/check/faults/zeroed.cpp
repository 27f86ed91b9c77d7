#include <algorithm>
#include <cmath>

#include "check/rows.h"

namespace dcnn::check {
namespace {

constexpr Eigen::Index kFirstRows = 10;

/// The first rows of a sensor that is zeroed when the recording begins read nothing but noise,
/// though the tool has a weight. By chance so near to zero: the share of the ball that the force is
/// in.
std::vector<Fault> find_zeroed(const Evidence& e) {
  const Adopted& a = e.adopted;
  // A force without its weight begins near zero anyway.
  if (e.log.declared.read.payload.mass > 0.0) return {};
  if (!a.compared || !e.log.smooth || e.log.rows() < 10 * kFirstRows || a.fit.mass <= 0.0)
    return {};
  const Eigen::MatrixXd F = e.log.block({"fx", "fy", "fz"});
  const Eigen::Vector3d first = F.topRows(kFirstRows).colwise().mean();
  double noise = 0.0;
  for (Eigen::Index j = 0; j < 3; ++j) noise += std::pow(noise_of(F.col(j)), 2);
  noise = std::sqrt(noise / static_cast<double>(kFirstRows));
  const double size = std::sqrt(F.squaredNorm() / static_cast<double>(F.rows()));
  const double weight = a.reading.force > 0.0 ? 9.81 * a.fit.mass / a.reading.force : 0.0;
  if (size <= 0.0 || weight < 10.0 * noise) return {};
  const double near = std::max(first.norm(), noise) / size;
  const double probability = posterior_of_p(std::min(1.0, near * near * near));
  if (probability < kLikely) return {};
  return {
      fault_of(zeroed_fault, probability, "fx",
               "the force begins at zero (" + brief(first.norm()) + " within " + brief(size) +
                   "): the sensor was zeroed at the start, its offset is this recording's own")};
}

}  // namespace

const FaultKind zeroed_fault{
    "zeroed", false, "do not carry the offset from one recording to another; dcnn-diagnose --zeroed estimates one for each",
    "", find_zeroed};

}  // namespace dcnn::check
