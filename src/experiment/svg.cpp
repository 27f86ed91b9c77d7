// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "dcnn/experiment/report.h"
#include "experiment/axis.h"
#include "experiment/legend.h"
#include "experiment/markup.h"
#include "experiment/series.h"
#include "experiment/svg_marks.h"
#include "experiment/thinning.h"

namespace dcnn {
namespace {

/// Draws one chart: top to bottom title, plot, axis labels, legend (never over the data).
class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart) {
    for (const auto& series : chart.series) {
      points_.push_back(drawable_points(series, chart.log_y));
      bar_series_ += has_bars(series) ? 1 : 0;
      marker_series_ += apart(series) ? 1 : 0;
    }
    measure_bars();
    make_axes();
    lay_out();
  }

  std::string draw() {
    body_ = box({0, 0}, chart_.width, height_, "fill=\"#fff\"");
    draw_axes();
    std::size_t bar = 0;
    for (std::size_t k = 0; k < chart_.series.size(); ++k) {
      if (has_bars(chart_.series[k])) draw_bars(k, bar++);
    }
    std::size_t place = 0;
    for (std::size_t k = 0; k < chart_.series.size(); ++k) {
      if (!has_bars(chart_.series[k])) draw_line(k, apart(chart_.series[k]) ? offset(place++) : 0);
    }
    body_ += legend_.draw(chart_, height_);
    return svg_document(chart_.width, height_, chart_.title, body_);
  }

 private:
  double error(std::size_t k, std::size_t i) const {
    const auto& errors = chart_.series[k].error;
    return i < errors.size() && std::isfinite(errors[i]) ? std::abs(errors[i]) : 0;
  }

  /// Ends of an error bar; both the point itself where there is none.
  std::pair<double, double> bar_ends(std::size_t k, std::size_t i) const {
    const Series& series = chart_.series[k];
    const double middle = i < series.middle.size() ? series.middle[i] : series.y[i];
    const double half = error(k, i);
    return {std::min(series.y[i], middle - half), std::max(series.y[i], middle + half)};
  }

  bool apart(const Series& series) const {
    return chart_.side_by_side && series.style == Series::Style::kMarkers;
  }

  /// Where in its category's slot the markers of a series stand.
  double offset(std::size_t place) const {
    return 0.84 * ((static_cast<double>(place) + 0.5) / static_cast<double>(marker_series_) - 0.5);
  }

  /// The smallest distance between bars of one series: what a group of bars shares.
  void measure_bars() {
    if (!chart_.categories.empty()) return;
    double least = INFINITY;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const auto& x = chart_.series[k].x;
      for (std::size_t i = 1; has_bars(chart_.series[k]) && i < points_[k].size(); ++i) {
        const double gap = std::abs(x[points_[k][i]] - x[points_[k][i - 1]]);
        if (gap > 0) least = std::min(least, gap);
      }
    }
    if (std::isfinite(least)) slot_ = least;
  }

  void make_axes() {
    double left = INFINITY, right = -INFINITY, low = INFINITY, high = -INFINITY;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const auto& series = chart_.series[k];
      const double half = has_bars(series) ? slot_ / 2 : 0;
      for (const auto i : points_[k]) {
        left = std::min(left, series.x[i] - half);
        right = std::max(right, series.x[i] + half);
        // On a logarithmic axis a bar that reaches down to nearly zero would squeeze all data.
        const auto [bar_low, bar_high] = bar_ends(k, i);
        low = std::min(low, chart_.log_y ? series.y[i] : bar_low);
        high = std::max(high, bar_high);
        if (has_bars(series) && !chart_.log_y) low = std::min(low, 0.0), high = std::max(high, 0.0);
      }
    }
    if (left > right) left = 0, right = 1, low = chart_.log_y ? 0.1 : 0, high = 1;
    const bool markers = std::any_of(chart_.series.begin(), chart_.series.end(), has_markers);
    const double room = markers ? 0.03 * (right - left) : 0;
    x_ = chart_.categories.empty() ? linear_axis(left - room, right + room, 8, false)
                                   : category_axis(chart_.categories);
    y_ = chart_.log_y ? log_axis(low, high) : linear_axis(low, high, 5, true);
  }

  void lay_out() {
    double widest = 0, longest = 0;
    for (const auto& tick : y_.ticks)
      widest = std::max(widest, kLetter * character_count(tick.label));
    for (const auto& word : chart_.categories)
      longest = std::max(longest, kLetter * character_count(word));
    left_ = 34 + widest;
    right_ = chart_.width - 18;
    tilted_ = longest >
              (right_ - left_) / std::max<double>(1, static_cast<double>(chart_.categories.size()));
    if (tilted_) left_ = std::max(left_, 0.87 * longest);  // cos 30°: the first word starts inside
    top_ = chart_.title.empty() ? 20 : 38;
    bottom_ = std::max(top_ + 60, chart_.height - 44 - (tilted_ ? 0.5 * longest : 0));
    if (chart_.legend) legend_ = Legend(chart_, left_, right_);
    height_ = std::max<double>(chart_.height, bottom_ + 44 + (tilted_ ? 0.5 * longest : 0)) +
              legend_.height();
  }

  Point at(double x, double y) const {
    return {left_ + x_.place(x) * (right_ - left_), bottom_ - y_.place(y) * (bottom_ - top_)};
  }

  void draw_axes() {
    for (const auto& tick : y_.ticks) {
      const double y = at(x_.low, tick.value).y;
      body_ += line({left_, y}, {right_, y}, "stroke=\"#ddd\" stroke-width=\"0.7\"");
      body_ += words({left_ - 7, y + 4}, tick.label, "text-anchor=\"end\"");
    }
    for (const auto& tick : x_.ticks) {
      const double x = at(tick.value, y_.low).x;
      body_ += line({x, bottom_}, {x, bottom_ + 4}, "stroke=\"#1a1a1a\"");
      const auto turn = "text-anchor=\"end\" transform=\"rotate(-30 " + number(x) + " " +
                        number(bottom_ + 14) + ")\"";
      body_ += words({x, bottom_ + (tilted_ ? 14 : 17)}, tick.label,
                     tilted_ ? turn : "text-anchor=\"middle\"");
    }
    for (std::size_t i = 1; chart_.side_by_side && i < chart_.categories.size(); ++i) {
      const double x = at(static_cast<double>(i) - 0.5, y_.low).x;
      body_ += line({x, top_}, {x, bottom_}, "stroke=\"#bbb\" stroke-width=\"0.7\"");
    }
    body_ += line({left_, top_}, {left_, bottom_}, "stroke=\"#1a1a1a\"");
    const double zero = y_.log ? bottom_ : at(x_.low, std::clamp(0.0, y_.low, y_.high)).y;
    body_ += line({left_, bottom_}, {right_, bottom_}, "stroke=\"#1a1a1a\"");
    if (zero < bottom_ - 1)
      body_ += line({left_, zero}, {right_, zero}, "stroke=\"#888\" stroke-width=\"0.7\"");
    draw_labels();
  }

  void draw_labels() {
    const double middle = (left_ + right_) / 2;
    body_ += words({left_, 18}, chart_.title, "font-size=\"13.5\" font-weight=\"bold\"");
    body_ += words({middle, height_ - legend_.height() - 8}, with_multiplier(chart_.x_label, x_),
                   "text-anchor=\"middle\"");
    const double centre = (top_ + bottom_) / 2;
    body_ += words({14, centre}, with_multiplier(chart_.y_label, y_),
                   "text-anchor=\"middle\" transform=\"rotate(-90 14 " + number(centre) + ")\"");
  }

  static std::string with_multiplier(const std::string& label, const ChartAxis& axis) {
    return axis.multiplier.empty() ? label : label + " (" + axis.multiplier + ")";
  }

  void draw_error(std::size_t k, std::size_t i, double x) {
    if (error(k, i) == 0) return;
    const auto [bar_low, bar_high] = bar_ends(k, i);
    const double low = at(0, bar_low).y, high = at(0, bar_high).y;
    const std::string dark =
        has_bars(chart_.series[k]) ? "stroke=\"#1a1a1a\"" : stroke(look(chart_, k));
    body_ += line({x, low}, {x, high}, dark);
    body_ +=
        line({x - 3.5, high}, {x + 3.5, high}, dark) + line({x - 3.5, low}, {x + 3.5, low}, dark);
  }

  /// "DCNN, 20 dB: 0.1324 ± 0.0021", what the pointer shows of one mark.
  std::string title_of(std::size_t k, std::size_t i) const {
    const Series& series = chart_.series[k];
    const auto place = static_cast<std::size_t>(std::max(0.0, series.x[i]));
    const std::string x =
        place < chart_.categories.size() ? chart_.categories[place] : significant(series.x[i], 4);
    return series.label + (series.label.empty() ? "" : ", ") + x + ": " +
           significant(series.y[i], 4) +
           (error(k, i) > 0 ? " ± " + significant(error(k, i), 2) : "");
  }

  void draw_bars(std::size_t k, std::size_t bar) {
    const auto& series = chart_.series[k];
    const double group = slot_ * (chart_.categories.empty() ? 1.0 : 0.76);
    const double width = group / static_cast<double>(bar_series_);
    for (const auto i : points_[k]) {
      const double left = series.x[i] - group / 2 + static_cast<double>(bar) * width;
      const Point a = at(left, series.y[i]);
      const Point b = at(left + width, y_.log ? y_.low : 0);
      body_ += box({a.x, std::min(a.y, b.y)}, b.x - a.x, std::abs(b.y - a.y),
                   filled(look(chart_, k)), title_of(k, i));
      draw_error(k, i, (a.x + b.x) / 2);
    }
  }

  void draw_line(std::size_t k, double shift) {
    const auto& series = chart_.series[k];
    const auto points = thinned(series, points_[k], chart_.width);
    if (has_line(series) && !points.empty()) {
      std::string path;
      for (const auto i : points) {
        const Point p = at(series.x[i] + shift, series.y[i]);
        path += (path.empty() ? "" : " ") + number(p.x) + "," + number(p.y);
      }
      body_ += "<polyline points=\"" + path + "\" fill=\"none\" stroke-linejoin=\"round\" " +
               dashed(look(chart_, k)) + closed("polyline", series.label);
    }
    for (const auto i : points) {
      const Point p = at(series.x[i] + shift, series.y[i]);
      draw_error(k, i, p.x);
      if (has_markers(series)) body_ += marker(p, look(chart_, k), title_of(k, i));
    }
  }

  const Chart& chart_;
  std::vector<std::vector<std::size_t>> points_;  // drawable, by series
  std::size_t bar_series_ = 0, marker_series_ = 0;
  double slot_ = 1;  // width of a group of bars in x
  ChartAxis x_, y_;
  double left_ = 0, right_ = 0, top_ = 0, bottom_ = 0,
         height_ = 0;    // of the plot, and of the picture
  bool tilted_ = false;  // long words under the axis
  Legend legend_;
  std::string body_;
};

}  // namespace

std::string to_svg(const Chart& chart) { return Drawing(chart).draw(); }

}  // namespace dcnn
