#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

std::vector<Fault> find_counts(const Evidence& e) {
  std::vector<Fault> out;
  for (const std::string& name : measured_columns(e.log)) {
    const Eigen::VectorXd x = e.log.column(name);
    if ((x.array() != x.array().round()).any()) continue;
    const double range = x.maxCoeff() - x.minCoeff();
    // A physical quantity is printed as whole numbers where a unit of it is below the noise: then
    // its range in units is that of a sensor in its noise, some hundreds at least for counts.
    const double size = std::max(std::abs(x.maxCoeff()), std::abs(x.minCoeff()));
    const double p = elementary::exp(-std::min(range, size) / kCountsRange);
    const double probability = posterior_of_p(p);
    if (probability < kLikely) continue;
    out.push_back(fault_of(counts_fault, probability, name,
                           name + " holds whole numbers from " + brief(x.minCoeff()) + " to " +
                               brief(x.maxCoeff()) + ": raw counts"));
  }
  return out;
}

}  // namespace

const FaultKind counts_fault{"counts", true,
                             "multiply by the sensor's gain (axis 'scale' in a system description)",
                             "", find_counts};

}  // namespace dcnn::check
