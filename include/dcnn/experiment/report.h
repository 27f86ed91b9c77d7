// SPDX-License-Identifier: Apache-2.0
// Reports people look at: one self-contained HTML file, figures as inline SVG, no network.
#pragma once

#include <string>
#include <vector>

namespace dcnn {

/// One line or set of markers of a chart.
struct Series {
  std::string label;
  std::vector<double> x, y;
  std::vector<double> error;  ///< half-length of the error bars, empty for none
  enum class Style { kLine, kMarkers, kLineAndMarkers, kBars } style = Style::kLine;
  int look = -1;  ///< number of colour, dashes and marker; negative: its place in the chart
  std::vector<double> middle = {};  ///< of the error bars, empty where it is y
};

struct Chart {
  std::string title, x_label, y_label;
  std::vector<Series> series;
  std::vector<std::string>
      categories;  ///< x = 0, 1, … are these words (SNR levels), empty for numbers
  bool log_y = false;
  int width = 720, height = 320;
  bool side_by_side = false;  ///< markers of one category stand beside one another
  bool legend = true;
};

/// SVG text of a chart: axes with round ticks, legend, colour-blind-safe colours, readable in
/// print. Long lines are thinned to at most `2 * width` points by minimum and maximum per pixel
/// column.
std::string to_svg(const Chart& chart);
/// Its legend alone, of the chart's width.
std::string to_svg_legend(const Chart& chart);

/// An HTML document put together top to bottom.
class HtmlReport {
 public:
  explicit HtmlReport(std::string title);
  void heading(const std::string& text);
  void paragraph(const std::string& text);  ///< plain text, escaped
  void preformatted(const std::string& text);
  void table(const std::vector<std::string>& header,
             const std::vector<std::vector<std::string>>& rows);
  void chart(const Chart& chart, const std::string& caption);
  void drawing(const std::string& svg, const std::string& caption);  ///< an SVG made elsewhere
  /// One figure of several charts, two beside one another, under them the legend of the first.
  void panels(std::vector<Chart> charts, const std::string& caption);
  std::string html() const;

 private:
  std::string title_, body_;
};

/// Counts of the values in `bins` equal bins over their range, for histograms.
Chart histogram(const std::string& title, const std::string& x_label,
                const std::vector<std::vector<double>>& values,
                const std::vector<std::string>& labels, int bins);

}  // namespace dcnn
