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

double rate_lag(const std::vector<Recording>& recordings, const Axis& axis, double hz) {
  double difference = 0.0, match = 0.0, turning = 0.0, power = 0.0;
  for (const Recording& recording : recordings) {
    if (recording.dt <= 0.0) return 0.0;
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
        difference += late * late;
        match -= late * columns(i, 2);
        turning += columns(i, 2) * columns(i, 2);
        power += columns(i, 1) * columns(i, 1);
      }
    }
  }
  if (recordings.empty() || turning <= 0.0) return 0.0;
  const double lag = match / turning;
  const double explained = lag * match;
  const bool lags = lag >= kLeastLag * recordings.front().dt &&
                    explained > kMostlyLate * difference &&
                    explained > prior::kModelError * prior::kModelError * power;
  return lags ? lag : 0.0;
}

void leave_lagging_rates(std::vector<Recording>& recordings, System& system,
                         const std::vector<double>& motion_hz) {
  for (std::size_t k = 0; k < system.axes.size(); ++k) {
    Axis& axis = system.axes[k];
    if (axis.position.empty() || axis.velocity.empty()) continue;
    const double lag = rate_lag(recordings, axis, motion_hz[k]);
    if (lag <= 0.0) continue;
    recordings.front().notes.push_back(axis.velocity + " lags " + brief(1e3 * lag) +
                                       " ms behind the derivative of " + axis.position +
                                       ", which is used in its place");
    axis.velocity.clear();
  }
}

}  // namespace dcnn
