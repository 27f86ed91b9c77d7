// SPDX-License-Identifier: Apache-2.0
// The marks a chart is made of, as SVG elements. Looks are numbered: the k-th series has the k-th
// look.
#pragma once

#include <string>

namespace dcnn {

struct Point {
  double x, y;  // pixels, y downwards
};

constexpr int kPlainBlack = 7;   ///< the look of what is measured
constexpr double kLetter = 7.2;  ///< mean width of a character at 12 px, on the safe side

std::string number(double value);  ///< a coordinate

/// A whole picture [px] around its elements.
std::string svg_document(double width, double height, const std::string& title,
                         const std::string& body);

std::string line(Point a, Point b, const std::string& attributes);
std::string words(Point at, const std::string& text, const std::string& attributes);
/// With a `title`, which browsers show under the pointer.
std::string box(Point corner, double width, double height, const std::string& attributes,
                const std::string& title = "");
std::string marker(Point at, std::size_t k, const std::string& title = "");
/// The end of an element with such a title.
std::string closed(const char* element, const std::string& title);

std::string stroke(std::size_t k);  ///< attributes: colour
std::string dashed(std::size_t k);  ///< attributes: colour and dashes of a line
std::string filled(std::size_t k);  ///< attributes: colour and opacity of a bar

}  // namespace dcnn
