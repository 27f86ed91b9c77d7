#include <algorithm>
#include <cmath>

#include "dcnn/experiment/report.h"
#include "experiment/axis.h"
#include "experiment/markup.h"
#include "experiment/svg_marks.h"
#include "experiment/thinning.h"

namespace dcnn {
namespace {

constexpr double kLetter = 6.4;  // mean width of a character at 12 px, on the safe side
constexpr double kRow = 18;      // a row of the legend

bool has_line(const Series& series) {
  return series.style == Series::Style::kLine || series.style == Series::Style::kLineAndMarkers;
}

bool has_markers(const Series& series) {
  return series.style == Series::Style::kMarkers || series.style == Series::Style::kLineAndMarkers;
}

bool has_bars(const Series& series) { return series.style == Series::Style::kBars; }

/// Draws one chart: top to bottom title, plot, axis labels, legend (never over the data).
class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart) {
    for (const auto& series : chart.series) {
      points_.push_back(drawable_points(series, chart.log_y));
      bar_series_ += has_bars(series) ? 1 : 0;
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
    for (std::size_t k = 0; k < chart_.series.size(); ++k) {
      if (!has_bars(chart_.series[k])) draw_line(k);
    }
    draw_legend();
    const auto width = std::to_string(chart_.width), height = number(height_);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
           "\" viewBox=\"0 0 " + width + " " + height +
           "\" role=\"img\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\" "
           "fill=\"#1a1a1a\">\n<title>" +
           escape_markup(chart_.title) + "</title>\n" + body_ + "</svg>";
  }

 private:
  double error(std::size_t k, std::size_t i) const {
    const auto& errors = chart_.series[k].error;
    return i < errors.size() && std::isfinite(errors[i]) ? std::abs(errors[i]) : 0;
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
        low = std::min(low, series.y[i] - (chart_.log_y ? 0 : error(k, i)));
        high = std::max(high, series.y[i] + error(k, i));
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
    place_legend();
    height_ = std::max<double>(chart_.height, bottom_ + 44 + (tilted_ ? 0.5 * longest : 0)) +
              (legend_.empty() ? 0 : legend_.back().y + kRow + 4);
  }

  /// Rows of entries from left to right; y counts from below the axis label.
  void place_legend() {
    const bool labelled = std::any_of(chart_.series.begin(), chart_.series.end(),
                                      [](const auto& series) { return !series.label.empty(); });
    if (!labelled) return;
    double x = left_, y = 0;
    for (const auto& series : chart_.series) {
      const double width = 46 + kLetter * character_count(series.label);
      if (x > left_ && x + width > right_) x = left_, y += kRow;
      legend_.push_back({x, y});
      x += width;
    }
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
    body_ += line({left_, top_}, {left_, bottom_}, "stroke=\"#1a1a1a\"");
    const double zero = y_.log ? bottom_ : at(x_.low, std::clamp(0.0, y_.low, y_.high)).y;
    body_ += line({left_, bottom_}, {right_, bottom_}, "stroke=\"#1a1a1a\"");
    if (zero < bottom_ - 1)
      body_ += line({left_, zero}, {right_, zero}, "stroke=\"#888\" stroke-width=\"0.7\"");
    draw_labels();
  }

  void draw_labels() {
    const double middle = (left_ + right_) / 2,
                 legend = legend_.empty() ? 0 : legend_.back().y + kRow + 4;
    body_ += words({left_, 18}, chart_.title, "font-size=\"13.5\" font-weight=\"bold\"");
    body_ += words({middle, height_ - legend - 8}, with_multiplier(chart_.x_label, x_),
                   "text-anchor=\"middle\"");
    const double centre = (top_ + bottom_) / 2;
    body_ += words({14, centre}, with_multiplier(chart_.y_label, y_),
                   "text-anchor=\"middle\" transform=\"rotate(-90 14 " + number(centre) + ")\"");
  }

  static std::string with_multiplier(const std::string& label, const Axis& axis) {
    return axis.multiplier.empty() ? label : label + " (" + axis.multiplier + ")";
  }

  void draw_error(std::size_t k, std::size_t i, double x) {
    const double half = error(k, i), y = chart_.series[k].y[i];
    if (half == 0) return;
    const double low = at(0, y - half).y, high = at(0, y + half).y;
    const std::string dark = has_bars(chart_.series[k]) ? "stroke=\"#1a1a1a\"" : stroke(k);
    body_ += line({x, low}, {x, high}, dark);
    body_ +=
        line({x - 3.5, high}, {x + 3.5, high}, dark) + line({x - 3.5, low}, {x + 3.5, low}, dark);
  }

  void draw_bars(std::size_t k, std::size_t bar) {
    const auto& series = chart_.series[k];
    const double group = slot_ * (chart_.categories.empty() ? 1.0 : 0.76);
    const double width = group / static_cast<double>(bar_series_);
    for (const auto i : points_[k]) {
      const double left = series.x[i] - group / 2 + static_cast<double>(bar) * width;
      const Point a = at(left, series.y[i]);
      const Point b = at(left + width, y_.log ? y_.low : 0);
      body_ += box({a.x, std::min(a.y, b.y)}, b.x - a.x, std::abs(b.y - a.y), filled(k));
      draw_error(k, i, (a.x + b.x) / 2);
    }
  }

  void draw_line(std::size_t k) {
    const auto& series = chart_.series[k];
    const auto points = thinned(series, points_[k], chart_.width);
    if (has_line(series) && !points.empty()) {
      std::string path;
      for (const auto i : points) {
        const Point p = at(series.x[i], series.y[i]);
        path += (path.empty() ? "" : " ") + number(p.x) + "," + number(p.y);
      }
      body_ += "<polyline points=\"" + path + "\" fill=\"none\" stroke-linejoin=\"round\" " +
               dashed(k) + "/>\n";
    }
    for (const auto i : points) {
      const Point p = at(series.x[i], series.y[i]);
      draw_error(k, i, p.x);
      if (has_markers(series)) body_ += marker(p, k);
    }
  }

  void draw_legend() {
    const double top = height_ - (legend_.empty() ? 0 : legend_.back().y + kRow);
    for (std::size_t k = 0; k < legend_.size(); ++k) {
      const auto& series = chart_.series[k];
      const double x = legend_[k].x, y = top + legend_[k].y + 4;
      if (has_bars(series)) body_ += box({x + 6, y - 5}, 16, 10, filled(k));
      if (has_line(series)) body_ += line({x, y}, {x + 28, y}, dashed(k));
      if (has_markers(series)) body_ += marker({x + 14, y}, k);
      body_ += words({x + 34, y + 4}, series.label, "");
    }
  }

  const Chart& chart_;
  std::vector<std::vector<std::size_t>> points_;  // drawable, by series
  std::size_t bar_series_ = 0;
  double slot_ = 1;  // width of a group of bars in x
  Axis x_, y_;
  double left_ = 0, right_ = 0, top_ = 0, bottom_ = 0,
         height_ = 0;    // of the plot, and of the picture
  bool tilted_ = false;  // long words under the axis
  std::vector<Point> legend_;
  std::string body_;
};

}  // namespace

std::string to_svg(const Chart& chart) { return Drawing(chart).draw(); }

}  // namespace dcnn
