// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/dead_channels.h"

#include <algorithm>

#include "data/held_rows.h"
#include "dcnn/core/number.h"
#include "diagnosis/chain.h"

namespace dcnn {
namespace {

// Two readings of a living channel may agree by chance or by rounding; of so many, half of which
// rounding makes equal to the one before, all agree with a probability below 1e-5.
constexpr Index kFewestRows = 20;
// Of the largest range among the channels of the unit: what is smaller, rounding may hide.
constexpr double kLeastMoved = 0.1;

double range_of(const Eigen::VectorXd& x) { return x.maxCoeff() - x.minCoeff(); }

/// What should have moved the channel: its simulated part, or the axis' velocity.
bool is_driven(const Case& study, const Log& log, const Eigen::MatrixXd& simulated, Index channel) {
  double most = 0.0;
  for (Index j = 0; j < simulated.cols(); ++j) {
    if (study.units[std::size_t(j)] != study.units[std::size_t(channel)]) continue;
    most = std::max(most, range_of(simulated.col(j)));
  }
  if (most > 0.0 && range_of(simulated.col(channel)) >= kLeastMoved * most) return true;
  return study.axis && log.motion.v_B.rows() > 0 && range_of(log.motion.v_B.col(0)) > 0.0;
}

}  // namespace

void refuse_dead_channels(const Case& study) {
  const Signals simulated = predict(study, {});
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const Log& log = study.logs[k];
    if (log.measured.rows() < kFewestRows) continue;
    for (Index j = 0; j < study.channel_count(); ++j) {
      if (!never_changes(log.measured.col(j))) continue;
      if (!is_driven(study, log, simulated[k], j)) continue;
      // What a drive was told may be constant.
      if (study.axis && has_two_digits(log.measured(0, j))) continue;
      fail(Exit::kData, log.recording.name, ": column '",
           study.targets[static_cast<std::size_t>(j)], "' reads the same in all ",
           log.measured.rows(),
           " rows while the machine moves: a dead channel, which no law "
           "explains; repair it, or leave this recording out");
    }
  }
}

}  // namespace dcnn
