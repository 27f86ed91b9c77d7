// SPDX-License-Identifier: Apache-2.0
#include "data/even_clock.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "data/bridge.h"
#include "data/spline.h"
#include "dcnn/core/number.h"

namespace dcnn {
namespace {

constexpr Index kBeside = 25;       // rows on either side, over which a clock is taken to be even
constexpr double kOdds = 1000.0;    // at which stamps are believed
constexpr double kRowsOfOne = 5.0;  // that a fourth difference spans: independent ones are fewer
constexpr double kRounding = 1e-7;  // of a step: what a stamp's digits make

/// Sums of squares of a column's fourth differences, without and with the stamps.
struct Roughness {
  double even = 0.0, stamped = 0.0, count = 0.0;
};

void add_roughness(const Eigen::VectorXd& x, const Eigen::VectorXd& off,
                   const std::vector<Index>& places, double dt, Roughness& sums) {
  const Index n = x.size();
  // What a row's own time adds to it: speed by the two rows on either side.
  Eigen::VectorXd added = Eigen::VectorXd::Zero(n);
  for (Index i = 2; i + 2 < n; ++i) {
    const double ticks =
        static_cast<double>(places[std::size_t(i + 2)] - places[std::size_t(i - 2)]);
    added[i] = off[i] * (x[i + 2] - x[i - 2]) / (ticks * dt);
  }
  const auto fourth = [](const Eigen::VectorXd& y, Index i) {
    return y[i - 2] - 4.0 * y[i - 1] + 6.0 * y[i] - 4.0 * y[i + 1] + y[i + 2];
  };
  for (Index i = 4; i + 4 < n; ++i) {
    if (places[std::size_t(i + 2)] - places[std::size_t(i - 2)] != 4) continue;  // rows are lost
    const double even = fourth(x, i), stamped = even - fourth(added, i);
    sums.even += even * even;
    sums.stamped += stamped * stamped;
    sums.count += 1.0;
  }
}

}  // namespace

Eigen::VectorXd off_even_clock(const Eigen::VectorXd& t, const Segment& segment, double dt) {
  const std::vector<Index> places = clock_places(t, segment, dt);
  const Index n = segment.size();
  Eigen::VectorXd late(n), before = Eigen::VectorXd::Zero(n + 1), off(n);
  for (Index i = 0; i < n; ++i) {
    const double tick = dt * static_cast<double>(places[std::size_t(i)]);
    late[i] = t[segment.begin + i] - t[segment.begin] - tick;
    before[i + 1] = before[i] + late[i];
  }
  for (Index i = 0; i < n; ++i) {
    const Index half = std::min({kBeside, i, n - 1 - i});
    off[i] =
        late[i] - (before[i + half + 1] - before[i - half]) / static_cast<double>(2 * half + 1);
  }
  return off;
}

namespace {

/// Of all rows.
Eigen::VectorXd off_even_clock(const Recording& recording, const Eigen::VectorXd& t) {
  Eigen::VectorXd off = Eigen::VectorXd::Zero(t.size());
  for (const Segment& s : recording.segments) {
    off.segment(s.begin, s.size()) = off_even_clock(t, s, recording.dt);
  }
  return off;
}

double log_odds(const Recording& recording, const std::vector<std::string>& columns,
                const Eigen::VectorXd& t, const Eigen::VectorXd& off_even) {
  std::vector<Roughness> sums(columns.size());
  for (const Segment& s : recording.segments) {
    const Eigen::VectorXd off = off_even.segment(s.begin, s.size());
    if (off.cwiseAbs().maxCoeff() <= kRounding * recording.dt) continue;
    const std::vector<Index> places = clock_places(t, s, recording.dt);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (!recording.has(columns[k])) continue;
      add_roughness(recording.column(columns[k]).segment(s.begin, s.size()), off, places,
                    recording.dt, sums[k]);
    }
  }
  double sum = 0.0;
  for (const Roughness& r : sums) {
    if (r.even <= 0.0 || r.stamped <= 0.0) continue;  // a column that stands still
    sum += 0.5 * r.count / kRowsOfOne * elementary::log(r.even / r.stamped);
  }
  return sum;
}

}  // namespace

double log_odds_of_stamps(const Recording& recording, const std::vector<std::string>& columns) {
  const Eigen::VectorXd t = recording.column("t");
  return log_odds(recording, columns, t, off_even_clock(recording, t));
}

bool put_on_even_clock(Recording& recording, const std::vector<std::string>& columns) {
  if (recording.dt == 0.0 || !recording.has("t")) return false;
  const Eigen::VectorXd t = recording.column("t"), off = off_even_clock(recording, t);
  if (log_odds(recording, columns, t, off) <= elementary::log(kOdds)) return false;
  const Eigen::VectorXd even = t - off;
  for (const std::string& name : columns) {
    if (!recording.has(name)) continue;
    Eigen::VectorXd x = recording.column(name);
    for (const Segment& s : recording.segments) {
      const Eigen::VectorXd own = t.segment(s.begin, s.size());
      const Spline spline(own, x.segment(s.begin, s.size()));
      Index k = 0;
      for (Index i = 0; i < s.size(); ++i) {
        const double at = std::clamp(even[s.begin + i], own[0], own[own.size() - 1]);
        while (k + 2 < own.size() && own[k + 1] <= at) ++k;
        x[s.begin + i] = spline.value(at, k);
      }
    }
    recording.set(name, x);
  }
  recording.set("t", even);
  const double rms = std::sqrt(off.squaredNorm() / static_cast<double>(t.size()));
  recording.notes.push_back("rows are " + brief(1e3 * rms) +
                            " ms off an even clock, as their stamps say: the pose is put on one");
  return true;
}

}  // namespace dcnn
