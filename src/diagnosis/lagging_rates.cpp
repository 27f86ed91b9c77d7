// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/lagging_rates.h"

#include <algorithm>
#include <cmath>

#include "dcnn/core/number.h"
#include "dcnn/data/derivative.h"
#include "dcnn/data/filter.h"
#include "diagnosis/evidence/priors.h"

namespace dcnn {
namespace {

constexpr double kMostlyLate = 0.5;  // of a power
constexpr double kEnds = 5.0;        // periods of the fastest motion at either end of a segment
constexpr double kOfRate = 0.2;      // of the recordings' rate, beyond which no difference is one
/// Steps of the clock: a difference of neighbouring rows is half a step late.
constexpr double kLeastLag = 0.4;

}  // namespace

RateSums rate_sums(const std::vector<Recording>& recordings, const Axis& axis, double hz) {
  RateSums sums;
  for (const Recording& recording : recordings) {
    if (recording.dt <= 0.0) return {};
    const double top = std::min(hz, kOfRate / recording.dt);
    const Derivatives of_position =
        differentiate(recording.column(axis.position), recording,
                      {.kind = DerivativeSpec::Kind::kSpectral, .cutoff_hz = 2.0 * top});
    Eigen::MatrixXd columns(recording.samples(), 3);
    columns << recording.column(axis.velocity), of_position.first, of_position.second;
    columns = low_pass(columns, recording, top);
    const auto end = static_cast<Index>(std::llround(kEnds / top / recording.dt));
    for (const Segment& s : recording.segments) {
      for (Index i = s.begin + end; i < s.end - end; ++i) {
        const double late = columns(i, 0) - columns(i, 1);
        sums.difference += late * late;
        sums.match -= late * columns(i, 2);
        sums.turning += columns(i, 2) * columns(i, 2);
        sums.power += columns(i, 1) * columns(i, 1);
      }
    }
  }
  return sums;
}

double rate_lag(const std::vector<RateSums>& axes, double step) {
  RateSums all;
  for (const RateSums& axis : axes) {
    if (axis.difference <= 0.0) continue;
    all.difference += 1.0;
    all.match += axis.match / axis.difference;
    all.turning += axis.turning / axis.difference;
    all.power += axis.power / axis.difference;
  }
  if (all.turning <= 0.0) return 0.0;
  const double lag = all.match / all.turning;
  const double explained = lag * all.match;
  const bool lags = lag >= kLeastLag * step && explained > kMostlyLate * all.difference &&
                    explained > prior::kModelError * prior::kModelError * all.power;
  return lags ? lag : 0.0;
}

void leave_lagging_rates(std::vector<Recording>& recordings, System& system,
                         const std::vector<double>& motion_hz) {
  if (recordings.empty()) return;
  std::vector<RateSums> each(system.axes.size());
  for (std::size_t k = 0; k < each.size(); ++k) {
    const Axis& axis = system.axes[k];
    if (!axis.position.empty() && !axis.velocity.empty()) {
      each[k] = rate_sums(recordings, axis, motion_hz[k]);
    }
  }
  const double step = recordings.front().dt;
  const double together = rate_lag(each, step);
  for (std::size_t k = 0; k < each.size(); ++k) {
    Axis& axis = system.axes[k];
    const double lag = together > 0.0 ? together : rate_lag({each[k]}, step);
    if (lag <= 0.0 || each[k].difference <= 0.0) continue;
    recordings.front().notes.push_back(axis.velocity + " lags " + brief(1e3 * lag) +
                                       " ms behind the derivative of " + axis.position +
                                       ", which is used in its place");
    axis.velocity.clear();
  }
}

}  // namespace dcnn
