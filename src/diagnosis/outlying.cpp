// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/outlying.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/elementary.h"
#include "core/tails.h"
#include "data/median.h"
#include "dcnn/diagnosis/decision.h"
#include "diagnosis/evidence/priors.h"

namespace dcnn {
namespace {

constexpr double kOutlyingSeconds = 0.5;  // bursts of the noise are followed in as long ones
constexpr double kByChance = 0.01;        // that any stretch of a recording is called outlying
constexpr std::size_t kFewestHalfSeconds = 10;

/// Whether the log's readings are one and the same from `begin` to `end`: there they tell no level.
bool repeats(const Log& log, double begin, double end) {
  const Eigen::MatrixXd& readings = log.unfiltered.rows() > 0 ? log.unfiltered : log.measured;
  const Eigen::VectorXd& t = log.motion.t;
  const Index first = std::lower_bound(t.begin(), t.end(), begin) - t.begin();
  const Index rows = std::lower_bound(t.begin(), t.end(), end) - t.begin() - first;
  if (rows == 0) return true;
  const auto part = readings.middleRows(first, rows);
  return (part.rowwise() - part.row(0)).isZero(0.0);
}

struct HalfSecond {
  std::size_t log;
  double begin, size;  ///< s; logarithm of the mean square
};

std::vector<HalfSecond> half_seconds(const Setting& setting, const Signals& left,
                                     const std::vector<Span>& held_out, double seconds) {
  const Eigen::VectorXd residual = setting.whitener(left);
  const auto& info = setting.whitener.row_info();
  std::map<std::pair<std::size_t, std::int64_t>, std::pair<double, double>> sums;
  for (std::size_t row = 0; row < info.size(); ++row) {
    const auto& at = info[row];
    const bool held = std::any_of(held_out.begin(), held_out.end(),
                                  [&](const Span& s) { return s.holds(at.log, at.t); });
    if (held) continue;
    auto& [square, count] = sums[{at.log, static_cast<std::int64_t>(std::floor(at.t / seconds))}];
    const double r = residual(static_cast<Index>(row));
    square += r * r, count += 1.0;
  }
  std::vector<HalfSecond> list;
  for (const auto& [key, sum] : sums) {
    const double begin = static_cast<double>(key.second) * seconds;
    const bool still = repeats(setting.study.logs[key.first], begin, begin + seconds);
    if (still || sum.first == 0.0) continue;
    list.push_back({key.first, begin, elementary::log(sum.first / sum.second)});
  }
  return list;
}

}  // namespace

std::vector<Span> outlying(const Setting& setting, const Signals& left,
                           const std::vector<Span>& held_out) {
  const double seconds = kOutlyingSeconds * setting.study.axis_seconds;
  const auto all = half_seconds(setting, left, held_out, seconds);
  if (all.size() < kFewestHalfSeconds) return {};
  std::vector<double> sizes;
  for (const HalfSecond& s : all) sizes.push_back(s.size);
  const double middle = median(sizes);
  for (double& size : sizes) size = std::abs(size - middle);
  const double deviation = kDeviationOfMedian * median(sizes);
  std::vector<HalfSecond> foreign;
  std::map<std::size_t, double> of_log, foreign_of_log;
  double whole = 0.0;
  for (const HalfSecond& s : all) {
    whole += elementary::exp(s.size);
    of_log[s.log] += 1.0;
    const double tail = deviation > 0.0 ? normal_tail((s.size - middle) / deviation) : 1.0;
    if (tail * static_cast<double>(all.size()) >= kByChance) continue;
    foreign_of_log[s.log] += 1.0;
    foreign.push_back(s);
  }
  // A recording that is so for long shows other motion, as a faster one.
  std::erase_if(foreign, [&](const HalfSecond& s) {
    return foreign_of_log[s.log] > prior::kMostForeign * of_log[s.log];
  });
  std::vector<Span> spans;
  double theirs = 0.0;
  for (const HalfSecond& s : foreign) {
    const Eigen::VectorXd& t = setting.study.logs[s.log].motion.t;
    const double begin = std::max(s.begin - seconds, double(t(0))),
                 end = std::min(s.begin + 2.0 * seconds, double(t(t.size() - 1)));
    const bool continues = !spans.empty() && spans.back().log == s.log && begin <= spans.back().end;
    if (!continues) spans.push_back({s.log, begin, end});
    spans.back().end = end;
    theirs += elementary::exp(s.size);
  }
  // With less of the energy they decide about no number.
  return theirs >= kMachineShare * whole ? spans : std::vector<Span>{};
}

}  // namespace dcnn
