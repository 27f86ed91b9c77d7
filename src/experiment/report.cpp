// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/report.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"
#include "dcnn/experiment/provenance.h"
#include "experiment/markup.h"
#include "experiment/page_assets.h"
#include "experiment/plot_data.h"

namespace dcnn {
namespace {

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

/// Widest word of a text, in characters.
int longest_word(const std::string& text) {
  int longest = 0;
  for (std::size_t from = 0; from <= text.size();) {
    const auto to = std::min(text.find(' ', from), text.size());
    longest = std::max(longest, character_count(text.substr(from, to - from)));
    from = to + 1;
  }
  return longest;
}

/// A table before it is written: what browsers will make of it decides how it is shown.
struct TableText {
  const std::vector<std::string>& header;
  const std::vector<std::vector<std::string>>& rows;
  std::vector<bool> numeric;

  TableText(const std::vector<std::string>& heads,
            const std::vector<std::vector<std::string>>& lines)
      : header(heads), rows(lines) {
    for (std::size_t i = 0; i < header.size(); ++i) {
      numeric.push_back(!rows.empty() && column_is_numeric(rows, i));
    }
  }

  /// Width in px: cells on one line each or, on a narrow screen, broken between words where they
  /// are no numbers. Sizes are those of page.css with a common sans-serif face.
  int width(bool narrow) const {
    const int character = 9, padding = narrow ? 12 : 26;
    int sum = 0;
    for (std::size_t i = 0; i < header.size(); ++i) {
      int widest = longest_word(header[i]);
      for (const auto& row : rows) {
        if (i >= row.size()) continue;
        const bool whole = numeric[i] || (!narrow && !is_long(row[i]));
        widest = std::max(widest, whole ? character_count(row[i]) : longest_word(row[i]));
        if (is_long(row[i])) widest = std::max(widest, narrow ? 12 : 19);  // the least width of .t
      }
      sum += character * widest + padding;
    }
    return sum;
  }
};

std::string table_row(const std::vector<std::string>& cells, const TableText& table,
                      const std::string& tag, bool labelled) {
  std::string row = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool right = i < table.numeric.size() && table.numeric[i];
    std::string kind = right ? " class=\"n\"" : is_long(cells[i]) ? " class=\"t\"" : "";
    if (labelled && i > 0 && i < table.header.size()) {
      kind += " data-label=\"" + escape_markup(table.header[i]) + "\"";
    }
    row += "<" + tag + kind + ">" + escape_markup(cells[i]) + "</" + tag + ">";
  }
  return row + "</tr>\n";
}

constexpr const char* kHeading = "<h2 id=\"";

/// Links to the headings of a page, in order.
std::string contents(const std::string& body) {
  std::string list;
  for (auto at = body.find(kHeading); at != body.npos; at = body.find(kHeading, at + 1)) {
    const auto id = at + std::string(kHeading).size(), end = body.find('"', id);
    const auto text = body.find('>', end) + 1;
    list += "<li><a href=\"#" + body.substr(id, end - id) + "\">" +
            body.substr(text, body.find("</h2>", text) - text) + "</a></li>\n";
  }
  return list.empty() ? "" : "<nav><ul>\n" + list + "</ul></nav>\n";
}

/// The page with its contents after what stands before the first heading: the answer.
std::string lead(const std::string& body) {
  const auto first = std::min(body.find("<h2"), body.size());
  std::string answer = body.substr(0, first);
  if (answer.starts_with("<p>")) answer.replace(0, 3, "<p class=\"answer\">");
  return answer + contents(body) + body.substr(first);
}

/// Largest input whose digest is worth the time.
constexpr std::size_t kMostHashed = std::size_t{1} << 30;

std::string digest_line(const std::filesystem::path& input) {
  std::error_code missing;
  if (!std::filesystem::is_regular_file(input, missing)) return "";
  try {
    return "<br/>" + escape_markup(input.filename().string()) + " SHA-256 " +
           sha256_hex({read_file(input, kMostHashed, Exit::kData)});
  } catch (const Error&) {
    return "";
  }
}

/// Command, version, day and inputs of the program that makes the page.
std::string origin() {
  const Provenance& from = provenance();
  if (from.command.empty()) return "";
  char day[16];
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  std::strftime(day, sizeof day, "%Y-%m-%d", gmtime_r(&now, &utc));
  std::string text = "<details><summary>made by " + escape_markup(from.version) + " on " + day +
                     "</summary>" + escape_markup(from.command);
  for (const auto& input : from.inputs) text += digest_line(input);
  return text + "</details>\n";
}

std::string scripts(const std::string& body) {
  const bool plots = body.find("class=\"data\"") != body.npos;
  return (plots ? "<script>" + std::string(plot_library()) + "</script>\n" : "") + "<script>" +
         std::string(page_script()) + "</script>\n";
}

}  // namespace

HtmlReport::HtmlReport(std::string title) : title_(std::move(title)) {}

void HtmlReport::heading(const std::string& text) {
  const auto id = std::to_string(std::count(body_.begin(), body_.end(), '\n'));
  body_ += kHeading + ("s" + id) + "\">" + escape_markup(text) + "</h2>\n";
}

void HtmlReport::paragraph(const std::string& text) {
  body_ += "<p>" + escape_markup(text) + "</p>\n";
}

void HtmlReport::preformatted(const std::string& text) {
  body_ += "<pre>" + escape_markup(text) + "</pre>\n";
}

void HtmlReport::table(const std::vector<std::string>& header,
                       const std::vector<std::vector<std::string>>& rows) {
  constexpr int kPage = 860, kNarrow = 300;  // px, of 900 and 370: faces differ in width
  const TableText table(header, rows);
  const bool stacked = table.width(true) > kNarrow;
  const std::string kind =
      std::string(table.width(false) > kPage ? " many" : "") + (stacked ? " stack" : "");
  body_ += "<div class=\"wide\"><table" +
           (kind.empty() ? "" : " class=\"" + kind.substr(1) + "\"") + ">\n<thead>" +
           table_row(header, table, "th", false) + "</thead>\n<tbody>\n";
  for (const auto& row : rows) body_ += table_row(row, table, "td", stacked);
  body_ += "</tbody>\n</table></div>\n";
}

void HtmlReport::chart(const Chart& chart, const std::string& caption) {
  const std::string data = plot_data(chart);
  drawing(to_svg(chart) + (data.empty() ? ""
                                        : "\n<script type=\"application/json\" class=\"data\">" +
                                              data + "</script>"),
          caption);
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
         title + "</title>\n<style>" + std::string(plot_style()) + std::string(page_style()) +
         "</style>\n</head>\n<body>\n<h1>" + title + "</h1>\n" + origin() + lead(body_) +
         scripts(body_) + "</body>\n</html>\n";
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
