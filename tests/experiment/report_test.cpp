// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <regex>
#include <set>

#include "experiment/axis.h"
#include "experiment/markup.h"
#include "experiment/thinning.h"

namespace dcnn {
namespace {

using Style = Series::Style;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// What is wrong with the tags of a text, empty when they balance and every '<' and '&' is markup.
std::string tag_fault(const std::string& text) {
  static const std::regex tag(
      R"(<(/?)([a-zA-Z!][a-zA-Z0-9]*)((?:\s+[a-zA-Z0-9:-]+="[^"<]*")*)\s*(/?)>)");
  static const std::regex stray(R"(&(?!amp;|lt;|gt;|quot;|#39;))");
  std::string between = text;
  std::vector<std::string> open;
  for (std::sregex_iterator it(text.begin(), text.end(), tag), end; it != end; ++it) {
    const std::string name = (*it)[2];
    if ((*it)[1].length() != 0) {
      if (open.empty() || open.back() != name) return "unexpected </" + name + ">";
      open.pop_back();
    } else if ((*it)[4].length() == 0) {
      open.push_back(name);
    }
  }
  between = std::regex_replace(between, tag, "");
  if (between.find('<') != between.npos)
    return "stray < before " + between.substr(between.find('<'), 30);
  if (std::regex_search(text, stray)) return "stray &";
  return open.empty() ? "" : "<" + open.back() + "> is never closed";
}

int count(const std::string& text, const std::string& word) {
  int found = 0;
  for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++found;
  return found;
}

void expect_sound(const std::string& svg) {
  EXPECT_EQ(tag_fault(svg), "");
  static const std::regex kTitle("<title>[^<]*</title>");  // text, not coordinates
  const std::string drawn = std::regex_replace(svg, kTitle, "");
  for (const char* word : {"nan", "inf", "e+", "–\""}) EXPECT_EQ(count(drawn, word), 0) << word;
}

Chart example(Style style) {
  Chart chart{.title = "RMSE",
              .x_label = "SNR [dB]",
              .y_label = "RMSE [N]",
              .series = {},
              .categories = {}};
  for (int k = 0; k < 9; ++k) {
    chart.series.push_back({"model " + std::to_string(k),
                            {0, 1, 2, 3},
                            {1.0 + k, 2, kNan, 4},
                            {0.1, 0.2, 0.3, kNan},
                            style});
  }
  return chart;
}

TEST(TagCheckerOfTheseTests, SeesFaults) {
  EXPECT_EQ(tag_fault("<a><b x=\"1\"/>&lt;</a>"), "");
  for (const char* text :
       {"<a>", "</a>", "<a><b></a></b>", "<a>1 < 2</a>", "<a>x & y</a>", "<a x=1></a>"}) {
    EXPECT_NE(tag_fault(text), "") << text;
  }
}

TEST(Svg, IsWellFormedInEveryStyleAndScale) {
  for (const auto style : {Style::kLine, Style::kMarkers, Style::kLineAndMarkers, Style::kBars}) {
    for (const bool log : {false, true}) {
      auto chart = example(style);
      chart.log_y = log;
      expect_sound(to_svg(chart));
      chart.categories = {"clean", "forty decibel of a very long name", "<30>", "20"};
      expect_sound(to_svg(chart));
    }
  }
}

TEST(Svg, SkipsWhatCannotBeDrawn) {
  const double infinity = std::numeric_limits<double>::infinity(),
               largest = std::numeric_limits<double>::max();
  const std::vector<std::vector<double>> hostile = {
      {},       {kNan},      {kNan, infinity}, {-infinity, 1},   {largest, -largest}, {0, 0},
      {-1, -2}, {5e-324, 0}, {1e16, 1e16 + 2}, {1e-300, 2e-300}, {-1e299, 1e299},     {7}};
  for (const auto& y : hostile) {
    for (const bool log : {false, true}) {
      for (const auto style : {Style::kLineAndMarkers, Style::kBars}) {
        Chart chart{.title = "t",
                    .x_label = "x",
                    .y_label = "y",
                    .series = {},
                    .categories = {},
                    .log_y = log};
        chart.series = {{"a", {0, 1}, y, {infinity}, style}, {"b", y, y, {}, style}};
        const auto svg = to_svg(chart);
        expect_sound(svg);
        EXPECT_LT(svg.size(), 20'000U);
      }
    }
  }
}

TEST(Svg, DrawsOnlyThePointsThatExist) {
  Chart chart{.title = "", .x_label = "", .y_label = "", .series = {}, .categories = {}};
  chart.series = {{"", {0, 1, 2}, {1, kNan, 2}, {}, Style::kMarkers}};
  EXPECT_EQ(count(to_svg(chart), "<path"), 2);
}

TEST(Svg, EscapesEveryText) {
  Chart chart{
      .title = "<t>&", .x_label = "\"x\"", .y_label = "a<b", .series = {}, .categories = {"<c>"}};
  chart.series = {{"</svg><script>", {0}, {1}, {}, Style::kBars}};
  const auto svg = to_svg(chart);
  expect_sound(svg);
  EXPECT_EQ(count(svg, "<script"), 0);
  EXPECT_EQ(count(svg, "&lt;script&gt;"), 2);  // in the legend, and under the pointer
}

TEST(Svg, LegendLiesBelowThePlot) {
  const auto chart = example(Style::kLine);
  const auto svg = to_svg(chart);
  const std::regex label(R"re(y="([0-9.]+)" >model)re");
  int labels = 0;
  for (std::sregex_iterator it(svg.begin(), svg.end(), label), end; it != end; ++it, ++labels) {
    EXPECT_GT(std::stod((*it)[1]), chart.height - 8);
  }
  EXPECT_EQ(labels, 9);
}

TEST(Svg, SeriesDifferWithoutColour) {
  auto chart = example(Style::kLineAndMarkers);
  chart.series.resize(7);
  const auto svg = to_svg(chart);
  std::set<std::string> dashes, markers;
  const std::regex dash(R"re(<polyline[^>]*stroke-dasharray="([^"]*)")re"),
      path(R"re(<path d="([^"]*)")re");
  for (std::sregex_iterator it(svg.begin(), svg.end(), dash), end; it != end; ++it)
    dashes.insert((*it)[1]);
  for (std::sregex_iterator it(svg.begin(), svg.end(), path), end; it != end; ++it)
    markers.insert((*it)[1]);
  EXPECT_EQ(dashes.size(), 6U) << "six dashed and one solid";
  EXPECT_EQ(markers.size(), 7U);
}

TEST(Svg, MarkersOfOneCategoryStandSideBySide) {
  auto chart = example(Style::kMarkers);
  chart.categories = {"clean", "40 dB", "30 dB", "20 dB"};
  chart.legend = false;
  const std::regex place(R"re(translate\(([0-9.]+) )re");
  const auto places = [&] {
    const auto svg = to_svg(chart);
    expect_sound(svg);
    std::set<std::string> found;
    for (std::sregex_iterator it(svg.begin(), svg.end(), place), end; it != end; ++it)
      found.insert((*it)[1]);
    return found.size();
  };
  EXPECT_EQ(places(), 3U) << "three categories have a value";
  chart.side_by_side = true;
  EXPECT_EQ(places(), 27U) << "nine series each";
}

TEST(Svg, AnErrorBarNeedNotHaveItsPointInTheMiddle) {
  Chart chart{"", "", "", {{"rate", {0, 1}, {1.0, 0.9}, {0.4, 0.1}, Style::kMarkers}}, {"a", "b"}};
  EXPECT_NE(to_svg(chart).find(">1.4<"), std::string::npos);
  chart.series[0].middle = {0.6, 0.9};
  EXPECT_EQ(to_svg(chart).find(">1.4<"), std::string::npos);
  EXPECT_NE(to_svg(chart).find(">0.2<"), std::string::npos);
}

TEST(Svg, ALegendAloneHasEveryEntryAndTheChartThenHasNone) {
  auto chart = example(Style::kMarkers);
  expect_sound(to_svg_legend(chart));
  EXPECT_EQ(count(to_svg_legend(chart), ">model"), 9);
  chart.legend = false;
  EXPECT_EQ(count(to_svg(chart), "model 0</text>"), 0);
  EXPECT_EQ(count(to_svg(chart), "<title>model 0, "), 4 - 1);  // what can be drawn
}

TEST(Svg, ASeriesMayHaveALookOfItsOwn) {
  auto chart = example(Style::kMarkers);
  chart.series.resize(2);
  chart.series[0].look = chart.series[1].look = 4;
  chart.series[1].style = Style::kLineAndMarkers;
  const auto svg = to_svg(chart);
  std::set<std::string> markers;
  const std::regex path(R"re(<path d="([^"]*)")re");
  for (std::sregex_iterator it(svg.begin(), svg.end(), path), end; it != end; ++it)
    markers.insert((*it)[1]);
  EXPECT_EQ(markers.size(), 1U);
}

TEST(Thinning, KeepsTheExtremesAndTheOrder) {
  Series series;
  std::mt19937 random(3);
  for (int i = 0; i < 100'000; ++i) {
    series.x.push_back(i * 0.002);
    series.y.push_back(static_cast<double>(random() % 1000));
  }
  series.y[31'417] = 1e6;
  series.y[77'777] = -1e6;
  const auto kept = thinned(series, drawable_points(series, false), 720);
  EXPECT_LE(kept.size(), 1440U);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), 31'417U));
  EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), 77'777U));
}

TEST(Thinning, BoundsCurvesThatTurnBack) {
  Series series;
  for (int i = 0; i < 50'000; ++i) {
    series.x.push_back(std::cos(i * 0.1));
    series.y.push_back(std::sin(i * 0.1));
  }
  EXPECT_LE(thinned(series, drawable_points(series, false), 720).size(), 1440U);
}

TEST(Axis, TicksAreRound) {
  const auto axis = linear_axis(0.013, 0.97, 5, true);
  std::vector<std::string> labels;
  for (const auto& tick : axis.ticks) labels.push_back(tick.label);
  EXPECT_EQ(labels, (std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  std::mt19937 random(5);
  for (int i = 0; i < 1000; ++i) {
    const double low =
        std::ldexp(static_cast<double>(random()) - 2e9, static_cast<int>(random() % 200) - 100);
    const double range =
        std::ldexp(static_cast<double>(random() + 1), static_cast<int>(random() % 200) - 100);
    const auto any = linear_axis(low, low + range, 5, true);
    EXPECT_LE(any.low, low + 1e-6 * range);
    EXPECT_GE(any.high, low + range - 1e-6 * range);
    EXPECT_GE(any.ticks.size(), 2U);
    EXPECT_LE(any.ticks.size(), 12U);
  }
}

TEST(Axis, LogarithmicTicksArePowersOfTen) {
  const auto axis = log_axis(2e-7, 0.3);
  EXPECT_EQ(axis.ticks.front().label, "10⁻⁷");
  EXPECT_NEAR(axis.place(1e-3), 4.0 / 7.0, 1e-12);
  EXPECT_EQ(axis.place(-1), 0);
  EXPECT_EQ(log_axis(0.02, 0.05).ticks.size(), 4U) << "0.01 0.02 0.05 0.10";
}

TEST(Axis, LogarithmicAxesDoNotWasteHalfADecade) {
  const auto axis = log_axis(0.25, 3.7);
  EXPECT_DOUBLE_EQ(axis.low, 0.2);
  EXPECT_DOUBLE_EQ(axis.high, 5.0);
  EXPECT_EQ(axis.ticks.front().label, "0.2");
  EXPECT_EQ(axis.ticks.back().label, "5");
}

TEST(Axis, SmallNumbersShareOneMultiplier) {
  const auto axis = linear_axis(0, 4e-6, 4, true);
  EXPECT_EQ(axis.multiplier, "×10⁻⁶");
  EXPECT_EQ(axis.ticks.back().label, "4");
}

TEST(Markup, NumbersDoNotDependOnTheLocale) {
  EXPECT_EQ(significant(1234.5678, 5), "1234.6");
  EXPECT_EQ(significant(kNan, 4), "–");
  EXPECT_EQ(fixed(-0.0001, 2), "0.00");
  EXPECT_EQ(escape_markup("a\x01<"), "a\uFFFD&lt;");
}

TEST(HtmlReport, IsWellFormedSelfContainedAndEscaped) {
  HtmlReport report("A & <B>");
  report.heading("<h>");
  report.paragraph("1 < 2 & 3");
  report.preformatted("<pre>");
  report.table({"<model>", "RMSE [N]"}, {{"a<b", "0.12"}, {"c", "–"}, {"short"}});
  report.table({"empty"}, {});
  report.chart(example(Style::kBars), "Fig. <1>");
  report.panels({example(Style::kMarkers), example(Style::kLine)}, "Fig. <2>");
  report.panels({}, "nothing");
  auto html = report.html();
  ASSERT_TRUE(html.starts_with("<!DOCTYPE html>\n"));
  html.erase(0, html.find('\n'));
  while (html.find("<script") != html.npos) {
    const auto from = html.find("<script");
    html.erase(from, html.find("</script>", from) + 9 - from);
  }
  const auto void_tags = std::regex_replace(html, std::regex(R"(<style>[^<]*</style>)"), "");
  EXPECT_EQ(tag_fault(void_tags), "");
  for (const char* word : {"src=", "href=\"http", "url(", "@import"})
    EXPECT_EQ(count(html, word), 0) << word;
  EXPECT_EQ(count(html, "<td class=\"n\">0.12</td>"), 1);
  EXPECT_EQ(count(html, "<td>a&lt;b</td>"), 1);
}

TEST(Histogram, CountsEveryFiniteValueOnce) {
  const auto chart = histogram("t", "r [N]", {{0, 1, 2, 3, 4, kNan}, {4, 4}}, {"a", "b"}, 4);
  ASSERT_EQ(chart.series.size(), 2U);
  EXPECT_EQ(chart.series[0].y, (std::vector<double>{1, 1, 1, 2}));
  EXPECT_EQ(chart.series[1].y, (std::vector<double>{0, 0, 0, 2}));
  EXPECT_EQ(chart.series[0].x, (std::vector<double>{0.5, 1.5, 2.5, 3.5}));
  EXPECT_TRUE(histogram("t", "x", {{kNan}}, {"a"}, 4).series.empty());
  EXPECT_EQ(histogram("t", "x", {{2, 2}}, {"a"}, 3).series[0].y, (std::vector<double>{0, 2, 0}));
}

}  // namespace
}  // namespace dcnn
