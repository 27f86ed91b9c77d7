// SPDX-License-Identifier: Apache-2.0
#include "data/bridge.h"

#include <algorithm>
#include <cmath>

#include "data/spline.h"

namespace dcnn {

std::vector<Index> clock_places(const Eigen::VectorXd& t, const Segment& segment, double dt) {
  std::vector<Index> places{0};
  for (Index i = segment.begin + 1; i < segment.end; ++i) {
    const Index ticks = std::llround((t[i] - t[i - 1]) / dt);
    places.push_back(places.back() + std::max<Index>(1, ticks));
  }
  return places;
}

Eigen::VectorXd bridged(const Eigen::Ref<const Eigen::VectorXd>& x,
                        const std::vector<Index>& places) {
  if (places.back() + 1 == x.size()) return x;
  Eigen::VectorXd t(x.size()), all(places.back() + 1);
  for (Index i = 0; i < x.size(); ++i) t[i] = static_cast<double>(places[std::size_t(i)]);
  const Spline spline(t, x);
  for (Index i = 0; i < x.size(); ++i) {
    all[places[std::size_t(i)]] = x[i];
    const Index next = i + 1 < x.size() ? places[std::size_t(i + 1)] : all.size();
    for (Index k = places[std::size_t(i)] + 1; k < next; ++k) {
      all[k] = spline.value(static_cast<double>(k), i);
    }
  }
  return all;
}

Bridged bridged(const Eigen::MatrixXd& signals, const Recording& recording) {
  const Eigen::VectorXd t = times_of(recording, signals.rows());
  Bridged all;
  std::vector<std::vector<Index>> places;
  Index rows = 0;
  for (const Segment& s : recording.segments) {
    places.push_back(clock_places(t, s, recording.dt));
    const Index count = places.back().back() + 1;
    all.segments.push_back({rows, rows + count});
    rows += count;
  }
  all.columns.resize(rows, signals.cols());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Segment &from = recording.segments[k], &to = all.segments[k];
    for (Index j = 0; j < signals.cols(); ++j) {
      all.columns.col(j).segment(to.begin, to.size()) =
          bridged(signals.col(j).segment(from.begin, from.size()), places[k]);
    }
  }
  return all;
}

Eigen::VectorXd times_of(const Recording& recording, Index rows) {
  if (recording.has("t")) return recording.column("t");
  return Eigen::VectorXd::LinSpaced(rows, 0.0, recording.dt * static_cast<double>(rows - 1));
}

}  // namespace dcnn
