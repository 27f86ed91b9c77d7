// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <sstream>

#include "data/clock.h"
#include "data/spline.h"

namespace dcnn {
namespace {

/// Where the rows of one segment go: source row and time of each new row.
struct Grid {
  std::vector<Index> source;  // the last old row (within the segment) not after the new time
  std::vector<double> t;
};

Grid make_grid(const Eigen::VectorXd& t, double hz) {
  Grid grid;
  const auto count = static_cast<Index>(std::floor((t[t.size() - 1] - t[0]) * hz + 1e-6)) + 1;
  Index k = 0;
  for (Index i = 0; i < count; ++i) {
    const double at = std::min(t[0] + static_cast<double>(i) / hz, t[t.size() - 1]);
    while (k + 1 < t.size() && t[k + 1] <= at) ++k;
    grid.source.push_back(k);
    grid.t.push_back(at);
  }
  return grid;
}

Eigen::VectorXd interpolate(const Grid& grid, const Eigen::VectorXd& t, const Eigen::VectorXd& x,
                            bool smooth) {
  Eigen::VectorXd out(static_cast<Index>(grid.t.size()));
  if (smooth) {
    const Spline spline(t, x);
    for (std::size_t i = 0; i < grid.t.size(); ++i) {
      out[static_cast<Index>(i)] = spline.value(grid.t[i], grid.source[i]);
    }
    return out;
  }
  for (std::size_t i = 0; i < grid.t.size(); ++i) {
    const Index k = grid.source[i], next = std::min(k + 1, t.size() - 1);
    const double part = next > k ? (grid.t[i] - t[k]) / (t[next] - t[k]) : 0.0;
    out[static_cast<Index>(i)] = (1.0 - part) * x[k] + part * x[next];
  }
  return out;
}

/// Adds the products of the weights that rows `lag` apart give to the same old rows.
void add_covariance(const Grid& grid, const Eigen::VectorXd& t, std::vector<double>& covariance) {
  const auto weight_of_next = [&](std::size_t i) {
    const Index k = grid.source[i];
    return k + 1 < t.size() ? (grid.t[i] - t[k]) / (t[k + 1] - t[k]) : 0.0;
  };
  for (std::size_t lag = 0; lag < covariance.size(); ++lag) {
    for (std::size_t i = 0; i + lag < grid.t.size(); ++i) {
      const Index apart = grid.source[i + lag] - grid.source[i];
      const double a = weight_of_next(i), b = weight_of_next(i + lag);
      if (apart == 0) covariance[lag] += (1.0 - a) * (1.0 - b) + a * b;
      if (apart == 1) covariance[lag] += a * (1.0 - b);
    }
  }
}

/// Recording::interpolated of new rows on these grids, the old ones `ratio` new ones apart.
std::vector<double> covariance_of(const std::vector<Grid>& grids,
                                  const std::vector<Eigen::VectorXd>& clocks, double ratio) {
  std::vector<double> covariance(static_cast<std::size_t>(std::ceil(2.0 * ratio)) + 2, 0.0);
  double rows = 0.0;
  for (std::size_t k = 0; k < grids.size(); ++k) {
    add_covariance(grids[k], clocks[k], covariance);
    rows += static_cast<double>(grids[k].t.size());
  }
  for (double& c : covariance) c /= rows;
  return covariance;
}

/// Of a clock as uneven as it is, all steps counting: else the new rows wander through the
/// intervals between old ones, and linear interpolation makes noise of them that comes and goes. As
/// it was where the two differ by more than an error: no clock of one rate.
double even_step(const Recording& recording, const Eigen::VectorXd& t) {
  constexpr double kAnyStep = 0.5, kError = 0.01;
  const StepCount count = count_steps(t, recording.dt, kAnyStep);
  return recording.dt * (std::abs(count.time - count.ticks) < kError * count.ticks
                             ? count.time / count.ticks
                             : 1.0);
}

/// What is a gap at the old rate may be some rows of a slower clock.
void bridge_short_gaps(Recording& recording, const Eigen::VectorXd& t, double step) {
  std::vector<Segment> segments{recording.segments.front()};
  for (std::size_t k = 1; k < recording.segments.size(); ++k) {
    const Segment& next = recording.segments[k];
    if (is_gap(t[next.begin] - t[next.begin - 1], std::max(step, recording.dt))) {
      segments.push_back(next);
    } else {
      segments.back().end = next.end;
    }
  }
  if (const std::size_t bridged = recording.segments.size() - segments.size(); bridged > 0) {
    recording.notes.push_back(
        std::to_string(bridged) +
        " of these gaps are shorter than five steps of the new clock: bridged");
  }
  recording.segments = std::move(segments);
}

}  // namespace

void resample(Recording& recording, double hz, const std::vector<std::string>& smooth) {
  const Table old = recording.table;
  const Eigen::VectorXd t = recording.column("t");
  if (hz == 0.0) hz = 1.0 / even_step(recording, t);
  constexpr double kMostRowsOfOne = 100.0;
  require(hz * recording.dt <= kMostRowsOfOne, Exit::kUsage, "resampling to ", hz,
          " Hz makes more than ", kMostRowsOfOne, " rows of each; the recording has ",
          1.0 / recording.dt, " Hz");
  bridge_short_gaps(recording, t, 1.0 / hz);
  std::vector<Grid> grids;
  std::vector<Segment> segments;
  for (const Segment& segment : recording.segments) {
    grids.push_back(make_grid(t.segment(segment.begin, segment.size()), hz));
    const Index begin = segments.empty() ? 0 : segments.back().end;
    segments.push_back({begin, begin + static_cast<Index>(grids.back().t.size())});
  }
  Eigen::MatrixXd values(segments.back().end, old.values.cols());
  std::vector<Eigen::VectorXd> clocks;
  for (std::size_t k = 0; k < grids.size(); ++k) {
    const Segment from = recording.segments[k], to = segments[k];
    const Eigen::VectorXd& clock = clocks.emplace_back(t.segment(from.begin, from.size()));
    for (Index column = 0; column < values.cols(); ++column) {
      const auto& name = old.columns[static_cast<std::size_t>(column)];
      const bool by_spline = std::find(smooth.begin(), smooth.end(), name) != smooth.end();
      values.col(column).segment(to.begin, to.size()) = interpolate(
          grids[k], clock, old.values.col(column).segment(from.begin, from.size()), by_spline);
    }
  }
  recording.table.values = std::move(values);
  recording.segments = std::move(segments);
  recording.interpolated = covariance_of(grids, clocks, recording.dt * hz);
  recording.dt = 1.0 / hz;
  std::ostringstream note;
  note << "resampled to " << hz << " Hz: pose by cubic spline, all other columns linearly";
  recording.notes.push_back(note.str());
}

}  // namespace dcnn
