// SPDX-License-Identifier: Apache-2.0
#include "experiment/legend.h"

#include <algorithm>

#include "experiment/markup.h"
#include "experiment/series.h"

namespace dcnn {
namespace {

constexpr double kRow = 18;

}  // namespace

Legend::Legend(const Chart& chart, double left, double right) {
  const bool labelled = std::any_of(chart.series.begin(), chart.series.end(),
                                    [](const auto& series) { return !series.label.empty(); });
  if (!labelled) return;
  double x = left, y = 0;
  for (const auto& series : chart.series) {
    const double width = 54 + kLetter * character_count(series.label);
    if (x > left && x + width > right) x = left, y += kRow;
    places_.push_back({x, y});
    x += width;
  }
}

double Legend::height() const { return places_.empty() ? 0 : places_.back().y + kRow + 4; }

std::string Legend::draw(const Chart& chart, double bottom) const {
  std::string body;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const auto& series = chart.series[k];
    const double x = places_[k].x, y = bottom - height() + places_[k].y + 8;
    if (has_bars(series)) body += box({x + 6, y - 5}, 16, 10, filled(look(chart, k)));
    if (has_line(series)) body += line({x, y}, {x + 28, y}, dashed(look(chart, k)));
    if (has_markers(series)) body += marker({x + 14, y}, look(chart, k));
    body += words({x + 34, y + 4}, series.label, "");
  }
  return body;
}

std::string to_svg_legend(const Chart& chart) {
  const Legend legend(chart, 0, chart.width);
  return svg_document(chart.width, legend.height() + 4, chart.title,
                      legend.draw(chart, legend.height() + 4));
}

}  // namespace dcnn
