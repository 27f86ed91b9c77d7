// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "check/priors.h"
#include "check/rows.h"
#include "core/tails.h"

namespace dcnn::check {
namespace {

constexpr double kLeastTurn = 0.05;  // rad; gravity then changes by 5 % of the weight

/// Probability that the mass as fitted is off by more than the share that counts as told: a normal
/// error of the fit's deviation.
double mass_is_untold(const Adopted& a) {
  if (a.fit.mass <= 0.0) return 1.0;
  return 2.0 * normal_tail(kMassTold * a.fit.mass / fit_deviations(a)[0]);
}

std::vector<Fault> find_no_motion(const Evidence& e) {
  if (!e.adopted.compared) return {};
  const auto& R = e.adopted.motion.R;
  Eigen::MatrixXd field(static_cast<Eigen::Index>(R.size()),
                        3);  // gravity alone, without accelerations
  for (Eigen::Index i = 0; i < field.rows(); ++i)
    field.row(i) = -kEarthGravity * R[static_cast<std::size_t>(i)].row(2);
  const Eigen::MatrixXd about = field.rowwise() - field.colwise().mean();
  const double turned =
      std::sqrt(about.squaredNorm() / static_cast<double>(field.rows())) / kEarthGravity;
  if (turned >= kLeastTurn || e.adopted.reading.compensated) return {};
  return {fault_of(no_motion_fault, mass_is_untold(e.adopted), "",
                   "the tool hardly turns (gravity in the sensor frame varies by " +
                       brief(100.0 * turned) +
                       " % of its size): mass, centre of mass and offset cannot be told apart")};
}

}  // namespace

const FaultKind no_motion_fault{
    "no_motion", false, "turn the tool by 45 degrees or more about two axes", "", find_no_motion};

}  // namespace dcnn::check
