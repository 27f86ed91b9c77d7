#include "diagnosis/rest.h"

#include <algorithm>
#include <cmath>

namespace dcnn {
namespace {

constexpr double kShortestRest = 0.5;  // s
constexpr double kAveragedSeconds =
    0.2;                               // s, over which noise of the rate hardly moves the position
constexpr double kShareAtRest = 0.01;  // of the 95th percentile of speed
constexpr double kFastShare = 0.95;    // its place in the distribution
constexpr double kLeastMovingShare = 0.1;  // of the time

/// abs of the mean rate over kAveragedSeconds about each row, within its segment.
Eigen::VectorXd mean_speed(const Motion& motion) {
  Eigen::VectorXd speed = Eigen::VectorXd::Zero(motion.samples());
  const auto half = static_cast<Index>(std::llround(0.5 * kAveragedSeconds / motion.dt));
  for (const Segment& s : motion.segments) {
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(s.size() + 1);
    for (Index i = 0; i < s.size(); ++i) sums(i + 1) = sums(i) + motion.v_B(s.begin + i, 0);
    for (Index i = 0; i < s.size(); ++i) {
      const Index from = std::max<Index>(0, i - half), to = std::min(s.size(), i + half + 1);
      speed(s.begin + i) = std::abs(sums(to) - sums(from)) / static_cast<double>(to - from);
    }
  }
  return speed;
}

}  // namespace

std::vector<Span> rests(const Case& study) {
  if (!study.axis || study.is_static() || !study.axis_moves) return {};
  std::vector<Eigen::VectorXd> speeds;
  std::vector<double> all;
  for (const Log& log : study.logs) {
    if (log.motion.v_B.rows() != log.motion.samples()) return {};
    speeds.push_back(mean_speed(log.motion));
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
