// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

/// Units that a channel of whole numbers ranges over; 0 of others.
double whole_range(const Eigen::VectorXd& x) {
  if ((x.array() != x.array().round()).any()) return 0.0;
  const double size = std::max(std::abs(x.maxCoeff()), std::abs(x.minCoeff()));
  return std::min(x.maxCoeff() - x.minCoeff(), size);
}

/// Probability that a physical quantity is printed as whole numbers of so large a range: it is
/// where a unit of it is below the noise, then its range in units is that of a sensor in its noise,
/// some hundreds at least for counts.
double chance_of(double range) { return elementary::exp(-range / kCountsRange); }

Fault counts_of(const Log& log, const std::string& name, double probability) {
  const Eigen::VectorXd x = log.column(name);
  return fault_of(counts_fault, probability, name,
                  name + " holds whole numbers from " + brief(x.minCoeff()) + " to " +
                      brief(x.maxCoeff()) + ": raw counts");
}

/// Forces that are no newtons, in whole numbers: another unit or counts, which are as likely
/// before. The unit prints whole numbers in each column by the chance above, counts always.
double counts_beside_units(const Evidence& e) {
  const std::vector<std::string> names{"fx", "fy", "fz"};
  if (!e.adopted.compared || e.adopted.reading.force == 1.0 || !e.log.has_all(names)) return 0.0;
  double range = 0.0;
  for (const std::string& name : names) {
    const double own = whole_range(e.log.column(name));
    if (own <= 0.0) return 0.0;
    range += own;
  }
  return 1.0 / (1.0 + chance_of(range));
}

std::vector<Fault> find_counts(const Evidence& e) {
  std::vector<Fault> out;
  const double beside = counts_beside_units(e);
  for (const std::string& name : measured_columns(e.log)) {
    const double range = whole_range(e.log.column(name));
    double probability = range > 0.0 ? posterior_of_p(chance_of(range)) : 0.0;
    if (name[0] == 'f') probability = std::max(probability, beside);
    if (probability >= kLikely) out.push_back(counts_of(e.log, name, probability));
  }
  return out;
}

}  // namespace

const FaultKind counts_fault{"counts", true,
                             "multiply by the sensor's gain (axis 'scale' in a system description)",
                             "", find_counts};

}  // namespace dcnn::check
