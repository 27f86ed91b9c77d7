// SPDX-License-Identifier: Apache-2.0
// What a series of a chart shows.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/experiment/report.h"

namespace dcnn {

inline std::vector<double> list_of(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }

inline bool has_line(const Series& series) {
  return series.style == Series::Style::kLine || series.style == Series::Style::kLineAndMarkers;
}

inline bool has_markers(const Series& series) {
  return series.style == Series::Style::kMarkers || series.style == Series::Style::kLineAndMarkers;
}

inline bool has_bars(const Series& series) { return series.style == Series::Style::kBars; }

/// The number of a series' look: its own, or its place in the chart.
inline std::size_t look(const Chart& chart, std::size_t k) {
  const int own = chart.series[k].look;
  return own < 0 ? k : static_cast<std::size_t>(own);
}

}  // namespace dcnn
