// SPDX-License-Identifier: Apache-2.0
#include "experiment/svg_marks.h"

#include <array>

#include "experiment/markup.h"

namespace dcnn {
namespace {

// Okabe and Ito 2008 without the yellow, which vanishes on white; dashes, markers and opacities
// differ too, so that charts read without colour. The last one is what the others are compared
// with.
constexpr std::array kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                 "#E69F00", "#56B4E9", "#6E6E6E", "#000000"};
constexpr std::array kDashes = {"", "7 3", "2 2.5", "9 3 2 3", "4 2", "12 4", "10 2 2 2 2 2", ""};
constexpr std::array kOpacities = {"0.85", "0.3", "0.6", "0.12"};
// Paths around the origin: disc, square, triangle, diamond, cross, plus, triangle downwards, bow
// tie; then the same hollow, but for cross and plus, which have no inside: star, hourglass.
constexpr std::array kMarkers = {"M-3.5 0a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0-7 0z",
                                 "M-3-3h6v6h-6z",
                                 "M0-4L4 3H-4z",
                                 "M0-4.5L4 0L0 4.5L-4 0z",
                                 "M-3-3L3 3M-3 3L3-3",
                                 "M-4 0H4M0-4V4",
                                 "M0 4L4-3H-4z",
                                 "M-4-3L4 3V-3L-4 3z",
                                 "M-3.5 0a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0-7 0z",
                                 "M-3-3h6v6h-6z",
                                 "M0-4L4 3H-4z",
                                 "M0-4.5L4 0L0 4.5L-4 0z",
                                 "M-4 0H4M-2-3.5L2 3.5M-2 3.5L2-3.5",
                                 "M-3-4H3L-3 4H3z",
                                 "M0 4L4-3H-4z",
                                 "M-4-3L4 3V-3L-4 3z"};

}  // namespace

std::string number(double value) { return fixed(value, 2); }

std::string svg_document(double width, double height, const std::string& title,
                         const std::string& body) {
  const auto w = fixed(width, 0), h = number(height);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h +
         "\" viewBox=\"0 0 " + w + " " + h +
         "\" role=\"img\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\" "
         "fill=\"#1a1a1a\">\n<title>" +
         escape_markup(title) + "</title>\n" + body + "</svg>";
}

std::string line(Point a, Point b, const std::string& attributes) {
  return "<line x1=\"" + number(a.x) + "\" y1=\"" + number(a.y) + "\" x2=\"" + number(b.x) +
         "\" y2=\"" + number(b.y) + "\" " + attributes + "/>\n";
}

std::string words(Point at, const std::string& text, const std::string& attributes) {
  return "<text x=\"" + number(at.x) + "\" y=\"" + number(at.y) + "\" " + attributes + ">" +
         escape_markup(text) + "</text>\n";
}

std::string closed(const char* element, const std::string& title) {
  if (title.empty()) return "/>\n";
  return "><title>" + escape_markup(title) + "</title></" + element + ">\n";
}

std::string box(Point corner, double width, double height, const std::string& attributes,
                const std::string& title) {
  return "<rect x=\"" + number(corner.x) + "\" y=\"" + number(corner.y) + "\" width=\"" +
         number(width) + "\" height=\"" + number(height) + "\" " + attributes +
         closed("rect", title);
}

std::string stroke(std::size_t k) {
  return std::string("stroke=\"") + kColours[k % kColours.size()] + "\"";
}

std::string dashed(std::size_t k) {
  // The second round of colours has other dashes.
  const std::string dash = kDashes[(k + 3 * (k / kColours.size())) % kDashes.size()];
  return stroke(k) + " stroke-width=\"1.6\"" +
         (dash.empty() ? "" : " stroke-dasharray=\"" + dash + "\"");
}

std::string filled(std::size_t k) {
  return std::string("fill=\"") + kColours[k % kColours.size()] + "\" fill-opacity=\"" +
         kOpacities[k % kOpacities.size()] + "\" " + stroke(k);
}

std::string marker(Point at, std::size_t k, const std::string& title) {
  const bool hollow = k / kColours.size() % 2 == 1;
  return std::string("<path d=\"") + kMarkers[k % kMarkers.size()] + "\" transform=\"translate(" +
         number(at.x) + " " + number(at.y) + ")\" fill=\"" +
         (hollow ? "#fff" : kColours[k % kColours.size()]) + "\" " + stroke(k) +
         (hollow ? " stroke-width=\"1.4\"" : "") + closed("path", title);
}

}  // namespace dcnn
