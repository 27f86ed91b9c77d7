// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/rest.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/periodograms.h"

namespace dcnn {
namespace {

constexpr double kShortestRest = 0.5;  // s
constexpr double kAveragedSeconds =
    0.2;  // s, over which noise of the rate hardly moves the position
constexpr double kGoldenRatio =
    1.618033988749895;                     // periods that divide one span divide no part of it
constexpr double kShareAtRest = 0.01;      // of the 95th percentile of speed
constexpr double kFastShare = 0.95;        // its place in the distribution
constexpr double kLeastMovingShare = 0.1;  // of the time

}  // namespace

std::vector<Span> rests(const Case& study) {
  if (!study.axis || study.is_static() || !study.axis_moves || study.rests_count) return {};
  std::vector<Eigen::VectorXd> speeds;
  std::vector<double> all;
  for (const Log& log : study.logs) {
    if (log.motion.v_B.rows() != log.motion.samples()) return {};
    const auto mean_over = [&](double seconds) -> Eigen::VectorXd {
      const auto half = static_cast<Index>(std::llround(0.5 * seconds / log.motion.dt));
      return moving_mean(log.motion.v_B.col(0), log.motion.segments, half).cwiseAbs().col(0);
    };
    // The mean of an oscillation over whole periods is zero too.
    speeds.push_back(
        mean_over(kAveragedSeconds).cwiseMax(mean_over(kAveragedSeconds / kGoldenRatio)));
    all.insert(all.end(), speeds.back().begin(), speeds.back().end());
  }
  if (all.empty()) return {};
  const auto fast = all.begin() + static_cast<std::ptrdiff_t>(kFastShare * double(all.size() - 1));
  std::nth_element(all.begin(), fast, all.end());
  const double still = kShareAtRest * *fast;
  std::vector<Span> spans;
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    const Motion& motion = study.logs[k].motion;
    for (const Segment& s : motion.segments) {
      for (Index begin = s.begin; begin < s.end;) {
        Index end = begin;
        while (end < s.end && speeds[k](end) <= still) ++end;
        if (motion.dt * double(end - begin) >= kShortestRest) {
          spans.push_back({k, motion.t(begin), motion.t(end - 1)});
        }
        begin = end + 1;
      }
    }
  }
  return share_within(study, spans) > 1.0 - kLeastMovingShare ? std::vector<Span>{} : spans;
}

std::pair<Index, Index> rows_of(const Motion& motion, const Span& span) {
  const auto from = std::lower_bound(motion.t.begin(), motion.t.end(), span.begin),
             to = std::upper_bound(motion.t.begin(), motion.t.end(), span.end);
  return {from - motion.t.begin(), to - motion.t.begin()};
}

double share_within(const Case& study, const std::vector<Span>& spans) {
  double within = 0.0, rows = 0.0;
  for (const Span& span : spans) {
    const auto [from, to] = rows_of(study.logs[span.log].motion, span);
    within += static_cast<double>(to - from);
  }
  for (const Log& log : study.logs) rows += static_cast<double>(log.motion.samples());
  return rows > 0.0 ? within / rows : 0.0;
}

}  // namespace dcnn
