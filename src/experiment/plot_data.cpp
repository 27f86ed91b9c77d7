// SPDX-License-Identifier: Apache-2.0
#include "experiment/plot_data.h"

#include <algorithm>
#include <cmath>

#include "dcnn/core/json.h"
#include "experiment/markup.h"
#include "experiment/series.h"
#include "experiment/svg_marks.h"

namespace dcnn {
namespace {

constexpr std::size_t kColumns = 3000, kFewest = 20;

bool is_plot(const Chart& chart) {
  if (!chart.categories.empty() || chart.log_y || chart.series.empty()) return false;
  const auto& x = chart.series.front().x;
  return x.size() >= kFewest && std::is_sorted(x.begin(), x.end()) &&
         std::all_of(chart.series.begin(), chart.series.end(), [&](const Series& s) {
           return s.style == Series::Style::kLine && s.x == x && s.y.size() == x.size();
         });
}

std::string cell(double value) { return std::isfinite(value) ? significant(value, 5) : "null"; }

/// "[x,a,b]," with the extreme value of every series over the rows [begin, end).
template <class Extreme>
void add_row(const Chart& chart, std::size_t at, std::size_t begin, std::size_t end,
             Extreme extreme, std::string& rows) {
  rows += (rows.empty() ? "[" : ",[") + significant(chart.series.front().x[at], 9);
  for (const Series& s : chart.series) {
    const auto first = s.y.begin() + static_cast<std::ptrdiff_t>(begin);
    rows += "," + cell(*extreme(first, s.y.begin() + static_cast<std::ptrdiff_t>(end)));
  }
  rows += "]";
}

std::string rows_of(const Chart& chart) {
  using Place = std::vector<double>::const_iterator;
  const std::size_t samples = chart.series.front().x.size();
  const std::size_t each = std::max<std::size_t>(1, (samples + kColumns - 1) / kColumns);
  std::string rows;
  for (std::size_t begin = 0; begin < samples; begin += each) {
    const std::size_t end = std::min(samples, begin + each);
    add_row(chart, begin, begin, end, [](Place a, Place b) { return std::min_element(a, b); }, rows);
    if (end - begin < 2) continue;
    add_row(chart, begin + (end - begin) / 2, begin, end,
            [](Place a, Place b) { return std::max_element(a, b); }, rows);
  }
  return rows;
}

}  // namespace

std::string plot_data(const Chart& chart) {
  if (!is_plot(chart)) return "";
  Json head{{"title", chart.title}, {"x", chart.x_label}, {"y", chart.y_label}};
  Json labels = Json::array(), colors = Json::array();
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    labels.push_back(chart.series[k].label);
    const std::string mark = stroke(look(chart, k));  // stroke="#0072B2"
    colors.push_back(mark.substr(mark.find('#'), 7));
  }
  head["labels"] = labels;
  head["colors"] = colors;
  std::string text = head.dump();
  for (auto at = text.find('<'); at != text.npos; at = text.find('<', at)) {
    text.replace(at, 1, "\\u003c");
  }
  text.back() = ',';
  return text + "\"rows\":[" + rows_of(chart) + "]}";
}

}  // namespace dcnn
