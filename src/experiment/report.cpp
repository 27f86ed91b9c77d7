#include "dcnn/experiment/report.h"

#include <algorithm>
#include <cmath>

#include "experiment/markup.h"

namespace dcnn {
namespace {

// Always dark on white: figures keep their colours on a dark desktop and on paper.
constexpr const char* kStyle = R"(
:root { color-scheme: light; }
body { max-width: 900px; margin: 2em auto; padding: 0 1em; background: #fff; color: #1a1a1a;
  font: 16px/1.5 system-ui, "Helvetica Neue", Arial, sans-serif; }
h1 { font-size: 1.6em; line-height: 1.25; }
h2 { font-size: 1.2em; margin-top: 2em; border-bottom: 1px solid #ccc; padding-bottom: .2em; }
p { max-width: 44em; }
table { border-collapse: collapse; margin: 1em 0; font-size: .9em; font-variant-numeric: tabular-nums;
  border-top: 2px solid #1a1a1a; border-bottom: 2px solid #1a1a1a; }
th, td { white-space: nowrap; padding: .25em .8em; text-align: left; vertical-align: top; }
thead { border-bottom: 1px solid #1a1a1a; }
.n { text-align: right; white-space: nowrap; }
.t { white-space: normal; min-width: 12em; overflow-wrap: anywhere; }
.wide { overflow-x: auto; }
pre { background: #f5f5f5; padding: .8em; overflow-x: auto; font-size: .85em; }
figure { margin: 1.5em 0; break-inside: avoid; }
svg { max-width: 100%; height: auto; }
.panels { display: grid; grid-template-columns: 1fr 1fr; gap: 0 .5em; }
figcaption { font-size: .9em; color: #444; max-width: 50em; }
@media print { body { margin: 0; max-width: none; font-size: 11pt; } h2 { break-after: avoid; } }
)";

/// Numbers, with unit, sign or bounds, and marks for what does not exist are set to the right.
bool looks_numeric(const std::string& cell) {
  if (cell.empty() || cell == "–" || cell == "-" || cell == "null") return true;
  const auto first = cell.find_first_not_of("+-−<>≤≥=~± [(");
  return first != cell.npos && cell[first] >= '0' && cell[first] <= '9';
}

/// Words that would make a table wider than the page are wrapped.
bool is_long(const std::string& cell) { return character_count(cell) > 36; }

bool column_is_numeric(const std::vector<std::vector<std::string>>& rows, std::size_t column) {
  return std::all_of(rows.begin(), rows.end(), [column](const auto& row) {
    return column >= row.size() || looks_numeric(row[column]);
  });
}

std::string table_row(const std::vector<std::string>& cells, const std::vector<bool>& numeric,
                      const std::string& tag) {
  std::string row = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool right = i < numeric.size() && numeric[i];
    const char* kind = right ? " class=\"n\">" : is_long(cells[i]) ? " class=\"t\">" : ">";
    row += "<" + tag + kind + escape_markup(cells[i]) + "</" + tag + ">";
  }
  return row + "</tr>\n";
}

}  // namespace

HtmlReport::HtmlReport(std::string title) : title_(std::move(title)) {}

void HtmlReport::heading(const std::string& text) {
  body_ += "<h2>" + escape_markup(text) + "</h2>\n";
}

void HtmlReport::paragraph(const std::string& text) {
  body_ += "<p>" + escape_markup(text) + "</p>\n";
}

void HtmlReport::preformatted(const std::string& text) {
  body_ += "<pre>" + escape_markup(text) + "</pre>\n";
}

void HtmlReport::table(const std::vector<std::string>& header,
                       const std::vector<std::vector<std::string>>& rows) {
  std::vector<bool> numeric;
  for (std::size_t i = 0; i < header.size(); ++i) {
    numeric.push_back(!rows.empty() && column_is_numeric(rows, i));
  }
  body_ += "<div class=\"wide\"><table>\n<thead>" + table_row(header, numeric, "th") +
           "</thead>\n<tbody>\n";
  for (const auto& row : rows) body_ += table_row(row, numeric, "td");
  body_ += "</tbody>\n</table></div>\n";
}

void HtmlReport::chart(const Chart& chart, const std::string& caption) {
  drawing(to_svg(chart), caption);
}

void HtmlReport::drawing(const std::string& svg, const std::string& caption) {
  body_ +=
      "<figure>\n" + svg + "\n<figcaption>" + escape_markup(caption) + "</figcaption>\n</figure>\n";
}

void HtmlReport::panels(std::vector<Chart> charts, const std::string& caption) {
  if (charts.empty()) return;
  Chart key = charts.front();
  key.width = 2 * key.width;
  body_ += "<figure>\n<div class=\"panels\">\n";
  for (Chart& chart : charts) {
    chart.legend = false;
    body_ += to_svg(chart) + "\n";
  }
  body_ += "</div>\n" + to_svg_legend(key) + "\n<figcaption>" + escape_markup(caption) +
           "</figcaption>\n</figure>\n";
}

std::string HtmlReport::html() const {
  const auto title = escape_markup(title_);
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>" +
         title + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + title +
         "</h1>\n" + body_ + "</body>\n</html>\n";
}

Chart histogram(const std::string& title, const std::string& x_label,
                const std::vector<std::vector<double>>& values,
                const std::vector<std::string>& labels, int bins) {
  Chart chart{
      .title = title, .x_label = x_label, .y_label = "count", .series = {}, .categories = {}};
  double low = INFINITY, high = -INFINITY;
  for (const auto& set : values) {
    for (const double value : set) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (low > high || bins < 1) return chart;
  const double width =
      high > low ? high / bins - low / bins : 1;  // no overflow at the largest numbers
  if (high == low) low -= 0.5 * bins;             // one value is in the middle
  for (std::size_t k = 0; k < values.size(); ++k) {
    Series series{.label = k < labels.size() ? labels[k] : "",
                  .x = {},
                  .y = {},
                  .error = {},
                  .style = Series::Style::kBars};
    series.y.assign(static_cast<std::size_t>(bins), 0.0);
    for (int i = 0; i < bins; ++i) series.x.push_back(low + (i + 0.5) * width);
    for (const double value : values[k]) {
      if (!std::isfinite(value)) continue;
      const double bin = std::clamp(std::floor(value / width - low / width), 0.0, bins - 1.0);
      ++series.y[static_cast<std::size_t>(bin)];
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace dcnn
