// SPDX-License-Identifier: Apache-2.0
// A law in words.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/core/number.h"
#include "physics/law/direction_text.h"
#include "physics/law/factor_text.h"

namespace dcnn::law {
namespace {

/// What `q` drives, in words.
std::string driven(const std::string& q, const FactorText& text) {
  switch (text.factor->memory) {
    case Memory::kLag:
      return q + " behind a lag of " + text.memory;
    case Memory::kUnevenLag:
      return q + " behind a lag of " + text.memory + " as it rises and " + text.second +
             " as it falls";
    case Memory::kHighPass:
      return "the deviation of " + q + " from its mean over the last " + text.memory;
    case Memory::kPlay:
      return q + " behind a play of " + text.memory + " to either side";
    case Memory::kPlays:
      return q + " behind many plays, of up to " + text.memory + " to either side";
    case Memory::kLags:
      return q + " behind many lags, " + text.memory + " within a factor of " + text.second;
    case Memory::kStop:
      return "the stretch that " + q + " makes before it slips at " + text.memory;
    case Memory::kDahl:
      return "the presliding of " + q + " over " + text.memory;
    case Memory::kSecondOrder:
      return q + " behind a second-order lag of " + text.memory + " and damping ratio " +
             text.second;
    case Memory::kDelay:
      return q + " " + text.memory + " before";
    case Memory::kThixotropic:
      return "a structure that " + text.memory + " of " + q + " breaks down and " + text.second +
             " of rest rebuild (thixotropy)";
    case Memory::kDwell:
      return "the time that " + q + " needed for the last " + text.memory;
    default:
      return q;
  }
}

/// What the shape is taken of, in words.
std::string subject(const FactorText& text) {
  return text.factor->remembered ? text.q.words : driven(text.q.words, text);
}

std::string from_centre(const FactorText& text) {
  return text.factor->centred ? ", from " + text.centre : "";
}

/// " rad": the unit of the scale behind a space; empty for none.
std::string unit_of(const FactorText& text) {
  const auto space = text.scale.find(' ');
  return space == std::string::npos ? "" : text.scale.substr(space);
}

std::string period(const FactorText& text) {
  return brief(2.0 * std::numbers::pi * std::abs(text.scale_value)) + unit_of(text);
}

/// "1.5th", "2nd".
std::string ordinal(double value) {
  const std::string number = brief(value);
  const char* const end = number == "1" ? "st" : number == "2" ? "nd" : number == "3" ? "rd" : "th";
  return number + end;
}

/// "following a curve of the angle alpha, from 0.1 at -0.5 rad to 0.3 at 0.5 rad, 1 at 0 rad".
std::string curve_clause(const FactorText& text) {
  const std::size_t last = text.curve.size() - 1;
  const auto is_less = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto at = std::max_element(text.curve.begin(), text.curve.end(), is_less);
  const auto peak = static_cast<std::size_t>(at - text.curve.begin());
  const auto told = [&](std::size_t node) {
    return brief(100.0 * text.curve[node]) + " % at " + brief(place(text, node)) + unit_of(text);
  };
  std::string clause = "following a curve of " + subject(text) + ": " + told(0);
  if (peak != 0 && peak != last) clause += ", " + told(peak);
  return clause + " and " + told(last);
}

std::string shape_clause(const FactorText& text) {
  if (!text.curve.empty()) return curve_clause(text);
  const std::string of = subject(text), name = text.shape->name, from = from_centre(text);
  const std::string pth = ordinal(text.extra);
  const std::string p = brief(text.extra), percent = brief(100.0 * text.extra);
  if (name == "linear") return "proportional to " + of + from;
  if (name == "power") return "growing as the " + pth + " power of " + of + from;
  if (name == "even_power") {
    return (text.extra < 0.0 ? "as the " : "growing as the ") + pth + " power of the size of " +
           of + from;
  }
  if (name == "inverse_power") return "falling as the " + pth + " power of " + of + from;
  if (name == "one_sided") {
    return "only where " + of + (text.scale_value > 0.0 ? " is above " : " is below ") +
           (text.factor->centred ? text.centre : "0") + ", as the " + pth + " power";
  }
  if (name == "asymmetric") {
    return "proportional to " + of + from + ", " + p + " times as strong where that is negative";
  }
  if (name == "tanh") return "with the sign of " + of + from + ", constant beyond " + text.scale;
  if (name == "peaked") return "largest at " + text.scale + " of " + of + from;
  if (name == "fading") return "largest at " + text.scale + " of " + of + from + " and fading";
  if (name == "dead_band") return "only beyond " + text.scale + " of " + of + from;
  if (name == "log") return "as the logarithm of " + of + " over " + text.scale + from;
  if (name == "gaussian") {
    return "where " + of + " is within " + text.scale + " of " +
           (text.factor->centred ? text.centre : "0");
  }
  if (name == "sine") return "periodic in " + of + " with " + period(text) + " a period";
  if (name == "switched") {
    return "other by " + percent + " % where " + of + " is above " +
           (text.factor->centred ? text.centre : "0");
  }
  if (name == "step") {
    return "only where " + of + (text.scale_value > 0.0 ? " is above " : " is below ") +
           (text.factor->centred ? text.centre : "0") + ", full within " +
           brief(std::abs(text.scale_value)) + unit_of(text) + " of it";
  }
  if (name == "exponential") {
    return (text.scale_value > 0.0 ? "falling" : "growing") + std::string(" by a factor e with ") +
           brief(std::abs(text.scale_value)) + unit_of(text) + " of " + of;
  }
  if (name == "affine") {
    return "stronger by " + percent + " % with each " + text.scale + " of " + of + from;
  }
  if (name == "wavy") {
    return "stronger and weaker by " + percent + " % with " + of + ", " + period(text) +
           " a period";
  }
  return "stronger by " + percent + " % where " + of + " is within " + text.scale + " of " +
         (text.factor->centred ? text.centre : "0");
}

/// "as the 2nd power of …, all of it behind a lag of 0.3 s".
std::string clause(const FactorText& text) {
  const std::string shape = shape_clause(text);
  return text.factor->remembered ? driven(shape + ", all of it", text) : shape;
}

}  // namespace

std::string words(const Law& law, const Terms& terms) {
  std::string text = beginning_words(law, terms);
  std::string at;
  double size = std::abs(law.numbers(0));
  for (const FactorText& factor : texts_of(law, terms)) {
    const std::string how = clause(factor);
    text += ", " + how;
    const double u = factor.shape->told_at;
    if (u == 0.0) continue;
    size *= std::abs(factor.shape->value(u, factor.extra));
    // Presliding has no unit: its size is told where it is complete.
    if (how.starts_with("largest at") || factor.factor->memory == Memory::kDahl ||
        factor.factor->memory == Memory::kStop) {
      continue;
    }
    const std::string where =
        u == 1.0 ? factor.scale : brief(u * std::abs(factor.scale_value)) + unit_of(factor);
    at += (at.empty() ? " at " : " and ") + where + " of " + factor.q.words;
  }
  const Structure& structure = law.structure;
  Eigen::Index next = 1;
  if (*directions()[structure.direction].unit) {
    at += (at.empty() ? " at " : " and ") + brief(law.numbers(next++)) + " " +
          directions()[structure.direction].unit;
  }
  next += own_numbers(structure);
  if (structure.direction_lagged) {
    text += ", the vector behind a lag of " + brief(law.numbers(next++)) + " s";
  }
  if (structure.presliding) {
    text += ", which builds up over " + brief(law.numbers(next++)) + " m of the path";
  }
  if (structure.lagged) text += ", following with " + brief(law.numbers(next)) + " s";
  if (structure.spread) {
    text += " within a factor of " + brief(law.numbers(next + 1)) + " (many lags)";
  }
  return text + ": " + brief(size) + " " + amplitude_unit(law, terms) + at;
}

}  // namespace dcnn::law
