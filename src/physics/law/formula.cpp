// SPDX-License-Identifier: Apache-2.0
// A law as text and LaTeX.
#include <map>

#include "dcnn/core/number.h"
#include "physics/law/direction_text.h"
#include "physics/law/factor_text.h"

namespace dcnn::law {
namespace {

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
      {Memory::kDwell, "dwell"}, {Memory::kSecondOrder, "second_order"},
      {Memory::kDelay, "delay"}, {Memory::kThixotropic, "thixotropic"},
      {Memory::kStop, "stop"},   {Memory::kLags, "lags"},
      {Memory::kPlays, "plays"}, {Memory::kUnevenLag, "uneven_lag"}};
  return names.at(memory);
}

/// What the shape is taken of, as a part of a formula.
std::string remembered(const std::string& q, const FactorText& text) {
  if (text.factor->memory == Memory::kNone) return q;
  return std::string(memory_name(text.factor->memory)) + "(" + q + ", " + text.memory +
         (text.second.empty() ? "" : ", " + text.second) + ")";
}

std::string state_expression(const FactorText& text) {
  return text.factor->remembered ? text.q.name : remembered(text.q.name, text);
}

/// "curve(alpha; -0.5: 0.1, 0: 1, 0.5: 0.3)", places in the unit of the coordinate.
std::string curve_expression(const FactorText& text) {
  std::string list;
  for (std::size_t k = 0; k < text.curve.size(); ++k) {
    list += (k == 0 ? "" : ", ") + brief(place(text, k)) + ": " + brief(text.curve[k]);
  }
  return "curve(" + state_expression(text) + "; " + list + ")";
}

/// (q - centre)/(scale), as a part of a formula.
std::string argument(const FactorText& text) {
  std::string q = state_expression(text);
  if (text.factor->centred) q = "(" + q + " - " + text.centre + ")";
  return "(" + q + "/" +
         (text.scale.find(' ') == std::string::npos ? text.scale : "(" + text.scale + ")") + ")";
}

/// f(u) with the argument in the place of u and the number in that of p.
std::string shape_expression(const FactorText& text) {
  if (!text.curve.empty()) return curve_expression(text);
  std::string form = replaced(text.shape->equation, "exp", "\1");  // no u and p of function names
  form = replaced(form, "p", brief(text.extra));
  form = replaced(form, "sgn(u) ", "sgn u ");
  form = replaced(form, "u", "\2");
  form = replaced(form, "\1", "exp");
  return replaced(form, "\2", argument(text));
}

std::string factor_expression(const FactorText& text) {
  const std::string shape = shape_expression(text);
  return text.factor->remembered ? remembered(shape, text) : shape;
}

/// "0.1\,\mathrm{m/s}".
std::string latex_number(double value, const std::string& unit) {
  const std::string number = brief(value);
  return unit.empty() ? number : number + "\\,\\mathrm{" + replaced(unit, "*", "\\,") + "}";
}

std::string latex_remembered(const std::string& q, const FactorText& text) {
  if (text.factor->memory == Memory::kNone) return q;
  return "\\mathcal{M}_{\\text{" + replaced(memory_name(text.factor->memory), "_", " ") + "}," +
         replaced(text.memory, " ", "\\,") +
         (text.second.empty() ? "" : "," + replaced(text.second, " ", "\\,")) + "}[" + q + "]";
}

/// The shape of what the coordinate drives, or of the coordinate itself.
std::string latex_shape(const FactorText& text) {
  const std::string name = text.q.name;
  const auto cut = name.find('_');
  std::string q = name.size() > 1 && cut == std::string::npos ? "\\text{" + name + "}" : name;
  if (cut != std::string::npos) {
    q = name.substr(0, cut) + "_{\\text{" + replaced(name.substr(cut + 1), "_", " ") + "}}";
  }
  const std::string state = state_unit(*text.factor, text.q);
  if (!text.factor->remembered) q = latex_remembered(q, text);
  if (text.factor->centred && text.curve.empty()) {
    q += " - " + latex_number(text.centre_value, state);
  }
  if (!text.curve.empty()) {
    std::string list;
    for (std::size_t k = 0; k < text.curve.size(); ++k) {
      list += (k == 0 ? "" : ",\\,") + brief(place(text, k)) + ":" + brief(text.curve[k]);
    }
    return "\\operatorname{curve}\\left(" + q + ";\\," + list + "\\right)";
  }
  const std::string u = "\\tfrac{" + q + "}{" + latex_number(text.scale_value, state) + "}";
  return replaced(replaced(text.shape->latex, "#", brief(text.extra)), "@", u);
}

std::string latex_factor(const FactorText& text) {
  const std::string shape = latex_shape(text);
  return text.factor->remembered ? latex_remembered(shape, text) : shape;
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
  if (structure.presliding) {
    vector = "presliding(" + vector + ", " + brief(law.numbers(next++)) + " m)";
  }
  if (structure.lagged) {
    const std::string tau = brief(law.numbers(next)) + " s";
    product = structure.spread
                  ? "lags(" + product + ", " + tau + ", " + brief(law.numbers(next + 1)) + ")"
                  : "lag(" + product + ", " + tau + ")";
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
  if (structure.presliding) {
    vector = "\\mathcal{M}_{\\text{presliding}," + latex_number(law.numbers(next++), "m") + "}[" +
             vector + "]";
  }
  if (structure.spread) {
    text = "\\mathcal{M}_{\\text{lags}," + latex_number(law.numbers(next), "s") + "," +
           brief(law.numbers(next + 1)) + "}[" + text + "]";
  } else if (structure.lagged) {
    text = lagged(text);
  }
  return terms.axis.empty() ? text + "\\;" + vector : text;
}

}  // namespace dcnn::law
