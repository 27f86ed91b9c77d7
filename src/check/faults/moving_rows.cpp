#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

/// Without a clock, rows are taken as poses at rest. Samples of a motion resemble their neighbours.
std::vector<Fault> find_moving_rows(const Evidence& e) {
  if (e.log.t.size() > 0 || !e.log.smooth) return {};
  double ratio = 0.0;
  bool moves = false;
  for (const std::string& name : e.log.positions()) {
    const Eigen::VectorXd x = e.log.column(name), steps = steps_of(x);
    const double spread = (x.array() - x.mean()).square().sum();
    if (spread <= 0.0) continue;
    ratio = std::max(ratio, steps.squaredNorm() / spread);
    // Dwells with several rows each are at rest most of the time: then steps are noise.
    moves = moves || median(steps.cwiseAbs()) > 3.0 * noise_of(x);
  }
  if (!moves || ratio <= 0.0) return {};
  const double z = (elementary::log(kOrderedRows.median) - elementary::log(ratio)) / kOrderedRows.below;
  if (z <= 0.0) return {};
  return {fault_of(moving_rows_fault, posterior_of_p(tail(z)), "t",
                   "there is no column t, yet the rows are samples of a motion (neighbours are alike): they are no "
                   "list of poses at rest")};
}

}  // namespace

const FaultKind moving_rows_fault{"moving_rows", true, "add a column t in seconds: row number times the sampling interval", "",
                                  find_moving_rows};

}  // namespace dcnn::check
