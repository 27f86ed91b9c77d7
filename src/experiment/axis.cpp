// SPDX-License-Identifier: Apache-2.0
#include "experiment/axis.h"

#include <algorithm>
#include <cmath>

#include "experiment/markup.h"

namespace dcnn {
namespace {

/// The smallest of 1, 2, 5 times a power of ten that is at least `step`.
double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= step * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::string superscript(int exponent) {
  static const char* const kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

/// A power of a thousand to take out of labels that would be long, else 0.
int common_exponent(double largest) {
  if (largest >= 1e-2 && largest < 1e5) return 0;
  return 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
}

/// Neither empty nor so narrow that neighbouring ticks are the same number.
void widen(double& low, double& high) {
  const double least = std::max({std::abs(low), std::abs(high), 1e-290}) * 1e-9;
  if (high - low > least) return;
  const double half = low == 0 && high == 0 ? 1 : std::abs(low) / 2 + least;
  low -= half;
  high += half;
}

}  // namespace

double ChartAxis::place(double value) const {
  if (!log) return (value - low) / (high - low);
  if (value <= low) return 0;
  return std::log(value / low) / std::log(high / low);
}

ChartAxis linear_axis(double low, double high, int wanted, bool outward) {
  widen(low, high);
  const double step = round_step((high - low) / std::max(wanted, 1));
  constexpr double kSlack = 1e-9;
  if (outward) {
    low = step * std::floor(low / step + kSlack);
    high = step * std::ceil(high / step - kSlack);
  }
  ChartAxis axis{.low = low, .high = high, .log = false, .ticks = {}, .multiplier = {}};
  const int exponent = common_exponent(std::max(std::abs(low), std::abs(high)));
  const double unit = std::pow(10.0, exponent);
  if (exponent != 0) axis.multiplier = "×10" + superscript(exponent);
  const int decimals =
      std::clamp(-static_cast<int>(std::floor(std::log10(step / unit) + kSlack)), 0, 12);
  const double first = std::ceil(low / step - kSlack);
  const double last = std::floor(high / step + kSlack);
  for (double k = first; k <= last; ++k) {
    axis.ticks.push_back({k * step, fixed(k * step / unit, decimals)});
  }
  return axis;
}

ChartAxis log_axis(double low, double high) {
  const int first = static_cast<int>(std::floor(std::log10(low) + 1e-9));
  const int last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(high) - 1e-9)));
  ChartAxis axis{.low = std::pow(10.0, first),
                 .high = std::pow(10.0, last),
                 .log = true,
                 .ticks = {},
                 .multiplier = {}};
  const int decades = last - first;
  if (decades == 2) {
    for (const double factor : {2.0, 5.0}) {
      if (low >= factor * std::pow(10.0, first)) axis.low = factor * std::pow(10.0, first);
    }
    for (const double factor : {5.0, 2.0}) {
      if (high <= factor * std::pow(10.0, last - 1)) axis.high = factor * std::pow(10.0, last - 1);
    }
  }
  const int stride = (decades + 7) / 8;
  const bool plain = first >= -3 && last <= 4;
  for (int decade = first; decade <= last; decade += stride) {
    for (const int factor : {1, 2, 5}) {
      const double value = factor * std::pow(10.0, decade);
      if (factor > 1 && (decades > 2 || decade == last)) continue;
      if (value < axis.low * (1 - 1e-9) || value > axis.high * (1 + 1e-9)) continue;
      const std::string mantissa = factor == 1 ? "" : std::to_string(factor) + "·";
      axis.ticks.push_back({value, plain ? fixed(value, std::max(0, -decade))
                                         : mantissa + "10" + superscript(decade)});
    }
  }
  return axis;
}

ChartAxis category_axis(const std::vector<std::string>& words) {
  ChartAxis axis{.low = -0.5,
                 .high = static_cast<double>(words.size()) - 0.5,
                 .log = false,
                 .ticks = {},
                 .multiplier = {}};
  for (std::size_t i = 0; i < words.size(); ++i) {
    axis.ticks.push_back({static_cast<double>(i), words[i]});
  }
  return axis;
}

}  // namespace dcnn
