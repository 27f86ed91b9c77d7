// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "data/spikes.h"

namespace dcnn::check {
namespace {

constexpr double kForeign = 8.0;    // robust deviations of the residual
constexpr double kMostShare = 0.4;  // of the recording; more is no exception
constexpr double kDuration = 0.25;  // s

/// A stretch whose residual is foreign to the rest: pieces of kDuration by their median, against
/// the deviation of such medians; the tail is Student's with five degrees of freedom.
std::vector<Fault> find_contact(const Evidence& e) {
  const Adopted& a = e.adopted;
  if (!a.compared || a.rows.half == 0 || (a.fit.mass <= 0.0 && !a.reading.compensated)) return {};
  const double seconds = e.log.step * a.reading.clock * static_cast<double>(a.rows.half);
  const auto piece = std::max<Eigen::Index>(3, std::llround(kDuration / seconds));
  const Eigen::MatrixXd& residual = a.beside_friction.residual;
  const Eigen::Index pieces = residual.rows() / piece;
  if (pieces < 12) return {};
  Eigen::VectorXd size(pieces);
  for (Eigen::Index k = 0; k < pieces; ++k) {
    Eigen::Vector3d middle;
    for (Eigen::Index j = 0; j < 3; ++j)
      middle[j] = median(residual.col(j).segment(k * piece, piece));
    size[k] = middle.norm();
  }
  const double spread = (a.fit.force.rowwise() - a.fit.force.colwise().mean()).norm() /
                        std::sqrt(static_cast<double>(3 * a.fit.force.rows()));
  const double scale =
      std::max(median(size) / 1.538, kToolError * spread);  // of a chi with 3 degrees
  const auto foreign = (size.array() > kForeign * scale).count();
  Eigen::Index worst = 0;
  const double z = size.maxCoeff(&worst) / scale;
  if (foreign < 1 || static_cast<double>(foreign) > kMostShare * static_cast<double>(pieces))
    return {};
  const double p = std::min(1.0, static_cast<double>(pieces) * heavy_tail(z));
  Eigen::Index begin = worst, end = worst + 1;
  while (begin > 0 && size[begin - 1] > 0.5 * kForeign * scale) --begin;
  while (end < pieces && size[end] > 0.5 * kForeign * scale) ++end;
  Fault fault = fault_of(contact_fault, posterior_of_p(p), "",
                         "a force of " + brief(size[worst]) +
                             " N that no rigid tool makes acts for a while: a contact, "
                             "a bump or a cable that pulls");
  const auto& rows = a.rows.centres;
  set_interval(e.log, rows[static_cast<std::size_t>(begin * piece)],
               rows[static_cast<std::size_t>(end * piece - 1)] + 1, fault);
  return {fault};
}

}  // namespace

const FaultKind contact_fault{
    "contact", false,
    "record without touching the tool, or cut these rows; dcnn-diagnose knows the effect", "",
    find_contact};

}  // namespace dcnn::check
