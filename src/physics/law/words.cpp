// A law as text, LaTeX and words.
#include <cmath>
#include <map>
#include <numbers>

#include "dcnn/core/number.h"
#include "dcnn/physics/law.h"
#include "physics/law/direction_text.h"

namespace dcnn::law {
namespace {

/// The numbers of one factor as texts with units.
struct FactorText {
  const Factor* factor;
  const Shape* shape;
  const Coordinate* q;
  std::string index = {}, memory = {}, damping = {}, centre = {}, scale = {};
  double centre_value = 0.0, scale_value = 1.0, extra = 0.0;
};

std::vector<FactorText> texts_of(const Law& law, const Terms& terms) {
  const auto list = numbers_of(law.structure, terms);
  std::vector<FactorText> texts;
  for (std::size_t k = 0; k < law.structure.factors.size(); ++k) {
    const Factor& factor = law.structure.factors[k];
    FactorText text{&factor, &shapes()[factor.shape], &terms.coordinates[factor.coordinate],
                    std::to_string(k + 1)};
    for (std::size_t i = 0; i < list.size(); ++i) {
      const double value = law.numbers(static_cast<Eigen::Index>(i));
      const std::string& unit = list[i].unit;
      const std::string told = brief(value) + (unit.empty() ? "" : " " + unit);
      const auto begins = [&](const std::string& stem) {
        return list[i].name == stem + text.index ||
               list[i].name.starts_with(stem + text.index + "_");
      };
      if (begins("memory_")) text.memory = told;
      if (begins("damping_")) text.damping = told;
      if (begins("centre_")) text.centre = told, text.centre_value = value;
      if (begins("scale_")) text.scale = told, text.scale_value = value;
      if (begins("power_") || begins("ratio_") || begins("gain_")) text.extra = value;
    }
    texts.push_back(text);
  }
  return texts;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

const char* memory_name(Memory memory) {
  static const std::map<Memory, const char*> names{
      {Memory::kLag, "lag"},     {Memory::kHighPass, "highpass"},
      {Memory::kPlay, "play"},   {Memory::kDahl, "dahl"},
      {Memory::kDwell, "dwell"}, {Memory::kSecondOrder, "second_order"}};
  return names.at(memory);
}

/// (q - centre)/(scale), as a part of a formula.
std::string argument(const FactorText& text) {
  std::string q = text.q->name;
  if (text.factor->memory != Memory::kNone) {
    q = std::string(memory_name(text.factor->memory)) + "(" + q + ", " + text.memory +
        (text.damping.empty() ? "" : ", " + text.damping) + ")";
  }
  if (text.factor->centred) q = "(" + q + " - " + text.centre + ")";
  return "(" + q + "/" +
         (text.scale.find(' ') == std::string::npos ? text.scale : "(" + text.scale + ")") + ")";
}

/// f(u) with the argument in the place of u and the number in that of p.
std::string factor_expression(const FactorText& text) {
  std::string form = replaced(text.shape->equation, "exp", "\1");  // no u and p of function names
  form = replaced(form, "p", brief(text.extra));
  form = replaced(form, "sgn(u) ", "sgn u ");
  form = replaced(form, "u", "\2");
  form = replaced(form, "\1", "exp");
  return replaced(form, "\2", argument(text));
}

/// "0.1\,\mathrm{m/s}".
std::string latex_number(double value, const std::string& unit) {
  const std::string number = brief(value);
  return unit.empty() ? number : number + "\\,\\mathrm{" + replaced(unit, "*", "\\,") + "}";
}

std::string latex_factor(const FactorText& text) {
  const std::string name = text.q->name;
  const auto cut = name.find('_');
  std::string q = name.size() > 1 && cut == std::string::npos ? "\\text{" + name + "}" : name;
  if (cut != std::string::npos) {
    q = name.substr(0, cut) + "_{\\text{" + replaced(name.substr(cut + 1), "_", " ") + "}}";
  }
  const std::string state = text.factor->memory == Memory::kDahl    ? ""
                            : text.factor->memory == Memory::kDwell ? "s"
                                                                    : text.q->unit;
  if (text.factor->memory != Memory::kNone) {
    q = std::string("\\mathcal{M}_{\\text{") + memory_name(text.factor->memory) + "}," +
        replaced(text.memory, " ", "\\,") + (text.damping.empty() ? "" : "," + text.damping) +
        "}[" + q + "]";
  }
  if (text.factor->centred) q += " - " + latex_number(text.centre_value, state);
  const std::string u = "\\tfrac{" + q + "}{" + latex_number(text.scale_value, state) + "}";
  return replaced(replaced(text.shape->latex, "#", brief(text.extra)), "@", u);
}

std::string amplitude_unit(const Law& law, const Terms& terms) {
  return law.structure.on_torque ? "N*m" : terms.force;
}

/// What the shape is taken of, in words.
std::string subject(const FactorText& text) {
  const std::string q = text.q->words;
  switch (text.factor->memory) {
    case Memory::kLag:
      return q + " behind a lag of " + text.memory;
    case Memory::kHighPass:
      return "the deviation of " + q + " from its mean over the last " + text.memory;
    case Memory::kPlay:
      return q + " behind a play of " + text.memory + " to either side";
    case Memory::kDahl:
      return "the presliding of " + q + " over " + text.memory;
    case Memory::kSecondOrder:
      return q + " behind a second-order lag of " + text.memory + " and damping ratio " +
             text.damping;
    case Memory::kDwell:
      return "the time that " + q + " needed for the last " + text.memory;
    default:
      return q;
  }
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

std::string clause(const FactorText& text) {
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

}  // namespace

std::string expression(const Law& law, const Terms& terms) {
  const Structure& structure = law.structure;
  const Direction& direction = directions()[structure.direction];
  std::string product = brief(law.numbers(0)) + " " + amplitude_unit(law, terms);
  for (const FactorText& text : texts_of(law, terms))
    product += " * [" + factor_expression(text) + "]";
  Eigen::Index next = 1;
  std::string vector = direction_name(law);
  if (*direction.unit) {
    vector += "/(" + brief(law.numbers(next++)) + " " + direction.unit + ")";
  }
  next += own_numbers(structure);
  if (structure.direction_lagged) {
    vector = "lag(" + vector + ", " + brief(law.numbers(next++)) + " s)";
  }
  if (structure.lagged) {
    product = "lag(" + product + ", " + brief(law.numbers(next)) + " s)";
  }
  return terms.axis.empty() ? product + " along " + vector : product;
}

std::string latex(const Law& law, const Terms& terms) {
  const Structure& structure = law.structure;
  const Direction& direction = directions()[structure.direction];
  std::string text = latex_number(law.numbers(0), amplitude_unit(law, terms));
  for (const FactorText& factor : texts_of(law, terms)) text += "\\;" + latex_factor(factor);
  Eigen::Index next = 1;
  std::string vector = "\\mathbf{e}_{\\text{" + replaced(direction_name(law), "_", " ") + "}}";
  if (*direction.unit) {
    vector = "\\frac{" + vector + "}{" + latex_number(law.numbers(next++), direction.unit) + "}";
  }
  next += own_numbers(structure);
  const auto lagged = [&](const std::string& of) {
    return "\\frac{1}{1 + " + latex_number(law.numbers(next++), "s") + "\\,d_t}\\left[" + of +
           "\\right]";
  };
  if (structure.direction_lagged) vector = lagged(vector);
  if (structure.lagged) text = lagged(text);
  return terms.axis.empty() ? text + "\\;" + vector : text;
}

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
    if (how.starts_with("largest at") || factor.factor->memory == Memory::kDahl) continue;
    const std::string where =
        u == 1.0 ? factor.scale : brief(u * std::abs(factor.scale_value)) + unit_of(factor);
    at += (at.empty() ? " at " : " and ") + where + " of " + factor.q->words;
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
  if (structure.lagged) text += ", following with " + brief(law.numbers(next)) + " s";
  return text + ": " + brief(size) + " " + amplitude_unit(law, terms) + at;
}

}  // namespace dcnn::law
