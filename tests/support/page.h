// SPDX-License-Identifier: Apache-2.0
// What every page of results must do: asked of each kind where its program is tested.
#pragma once

#include <gtest/gtest.h>

#include "support/chromium.h"
#include "support/sanitizer.h"

namespace dcnn::test {

/// Somebody uses a page: points at a plot, zooms, hides a series, goes back, sorts a table.
constexpr const char* kUse = R"js(
  const out = {width: innerWidth, wide: document.documentElement.scrollWidth, plots: 0, together: true};
  out.background = getComputedStyle(document.body).backgroundColor;
  out.cut = Array.from(document.querySelectorAll('.wide')).filter(box => box.scrollWidth > box.clientWidth + 1)
    .map(box => box.textContent.trim().slice(0, 60));
  const pictures = Array.from(document.querySelectorAll('figure > svg'));
  out.cut.push(...pictures.map(svg => svg.parentElement)
    .filter(box => box.scrollWidth > box.clientWidth + 1 && getComputedStyle(box).overflowX !== 'auto')
    .map(box => 'picture: ' + box.textContent.trim().slice(0, 60)));
  out.letters = pictures.filter(svg => svg.viewBox.baseVal.width > 0 && svg.getBoundingClientRect().width > 0)
    .map(svg => svg.getBoundingClientRect().width / svg.viewBox.baseVal.width).reduce((a, b) => Math.min(a, b), 1);
  out.pictures = document.querySelectorAll('figure svg').length;
  out.titles = document.querySelectorAll('figure svg rect > title, figure svg path > title, figure svg polyline > title').length;
  const group = [...groups.values()][0];
  if (group) {
    out.plots = group.length;
    const graph = group[0], area = graph.getArea(), box = graph.graphDiv.getBoundingClientRect();
    const event = (kind, share) => new MouseEvent(kind, {bubbles: true, cancelable: true, view: window, detail: 1,
      clientX: box.left + area.x + share * area.w, clientY: box.top + area.y + area.h / 2});
    const canvas = graph.graphDiv.querySelectorAll('canvas')[1];
    canvas.dispatchEvent(event('mousemove', 0.5));
    out.value = document.querySelector('.plot output').textContent;
    const whole = graph.xAxisRange();
    canvas.dispatchEvent(event('mousedown', 0.3));
    document.dispatchEvent(event('mousemove', 0.6));
    document.dispatchEvent(event('mouseup', 0.6));
    const part = graph.xAxisRange();
    out.zoom = (part[1] - part[0]) / (whole[1] - whole[0]);
    for (const other of group) out.together = out.together && Math.abs(other.xAxisRange()[0] - part[0]) < 1e-9;
    document.querySelector('.key input').click();
    out.visible = graph.visibility();
    document.querySelector('.key button').click();
    const again = graph.xAxisRange();
    out.reset = (again[1] - again[0]) / (whole[1] - whole[0]);
  }
  const table = document.querySelector('table'), head = table.tHead.rows[0].cells[1];
  head.click();
  out.sorted = Array.from(table.tBodies[0].rows, row => row.cells[1] ? row.cells[1].textContent : '');
  out.order = head.getAttribute('aria-sort');
  return out;
)js";

/// The page as it is printed: what is wider than the paper.
constexpr const char* kPrint = R"js(
  const out = {rules: 0};
  for (const sheet of document.styleSheets) {
    for (const rule of sheet.cssRules) {
      if (!rule.media) continue;
      if (rule.media.mediaText === 'print') { rule.media.mediaText = 'all'; ++out.rules; }
      else if (rule.media.mediaText === 'screen') rule.media.mediaText = 'not all';
    }
  }
  out.cut = Array.from(document.querySelectorAll('.wide')).filter(box => box.scrollWidth > box.clientWidth + 1)
    .map(box => box.scrollWidth + ' of ' + box.clientWidth + ': ' + box.textContent.trim().slice(0, 60));
  return out;
)js";
constexpr int kPaper = 718;  ///< A4 between Chromium's margins of 10 mm, in its pixels of 1/96 inch

/// The answer, a picture and a table before the table of contents, all of it without a script.
inline void expect_answer_first(const std::string& html) {
  const auto answer = html.find("<p class=\"answer\">"), picture = html.find("<figure>"),
             table = html.find("<table"), contents = std::min(html.find("<nav>"), html.size());
  EXPECT_LT(answer, picture);
  EXPECT_LT(picture, contents);
  EXPECT_LT(table, contents);
  EXPECT_EQ(html.find("<h2"), html.find("<h2", std::min(contents, html.size() - 1)));
}

/// What `kUse` saw: no complaint, nothing cut, and what there is to zoom and sort does so.
inline void expect_worked(const Json& seen, int width) {
  EXPECT_TRUE(seen["errors"].empty()) << seen["errors"].dump();
  ASSERT_TRUE(seen.contains("order")) << seen.dump();
  EXPECT_EQ(seen["width"].get<int>(), width);
  EXPECT_LE(seen["wide"].get<int>(), width) << "the page scrolls sideways";
  EXPECT_TRUE(seen["cut"].empty()) << "wider than the page: " << seen["cut"].dump();
  EXPECT_EQ(seen["order"].get<std::string>(), "ascending");
  if (seen["plots"].get<int>() == 0) {  // what the pointer shows is in the picture itself
    EXPECT_TRUE(seen["pictures"].get<int>() == 0 || seen["titles"].get<int>() > 0);
    return;
  }
  EXPECT_NEAR(seen["zoom"].get<double>(), 0.3, 0.05);
  EXPECT_NEAR(seen["reset"].get<double>(), 1.0, 1e-9);
  EXPECT_TRUE(seen["together"].get<bool>());
  EXPECT_NE(seen["value"].get<std::string>().find(" at "), std::string::npos);
  EXPECT_FALSE(seen["visible"][0].get<bool>());
}

/// A page of any kind on a desk and, in the dark, on a telephone. Without Chromium only its text.
inline void expect_usable_page(const std::string& html) {
  expect_answer_first(html);
  EXPECT_LT(html.size(), 8U << 20U);
  for (const char* foreign : {"src=\"http", "url(http", "@import", "<link", "<img"}) {
    EXPECT_EQ(html.find(foreign), std::string::npos) << foreign;
  }
  if (kSanitized || !has_chromium()) return;
  expect_worked(browse(html, kUse), 1000);
  const Json narrow = browse(html, kUse, 400, "--blink-settings=preferredColorScheme=0");
  expect_worked(narrow, 400);
  EXPECT_GT(narrow["letters"].get<double>(), 0.7) << "letters of figures shrink on a telephone";
  EXPECT_EQ(narrow["background"].get<std::string>(), "rgb(22, 24, 27)");
}

}  // namespace dcnn::test
