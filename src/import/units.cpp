// SPDX-License-Identifier: Apache-2.0
#include "import/units.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>
#include <utility>
#include <vector>

#include "data/text.h"

namespace dcnn {
namespace {

struct UnitRow {
  const char* unit;
  const char* quantity;
  double factor = 1.0, origin = 0.0;
};

constexpr double kRadian = std::numbers::pi / 180.0;
constexpr double kGravity = 9.80665;  // m/s^2, of kgf and g by definition
constexpr double kPoundForce = 4.4482216152605;
constexpr double kInch = 0.0254;

const std::array kUnits = {UnitRow{"s", "time"},
                           UnitRow{"sec", "time"},
                           UnitRow{"secs", "time"},
                           UnitRow{"second", "time"},
                           UnitRow{"seconds", "time"},
                           UnitRow{"ms", "time", 1e-3},
                           UnitRow{"msec", "time", 1e-3},
                           UnitRow{"us", "time", 1e-6},
                           UnitRow{"\xC2\xB5s", "time", 1e-6},
                           UnitRow{"\xCE\xBCs", "time", 1e-6},
                           UnitRow{"usec", "time", 1e-6},
                           UnitRow{"ns", "time", 1e-9},
                           UnitRow{"nsec", "time", 1e-9},
                           UnitRow{"nsecs", "time", 1e-9},
                           UnitRow{"min", "time", 60.0},
                           UnitRow{"m", "length"},
                           UnitRow{"mm", "length", 1e-3},
                           UnitRow{"cm", "length", 1e-2},
                           UnitRow{"um", "length", 1e-6},
                           UnitRow{"inch", "length", kInch},
                           UnitRow{"in", "length", kInch},
                           UnitRow{"ft", "length", 12.0 * kInch},
                           UnitRow{"rad", "angle"},
                           UnitRow{"mrad", "angle", 1e-3},
                           UnitRow{"deg", "angle", kRadian},
                           UnitRow{"degree", "angle", kRadian},
                           UnitRow{"degrees", "angle", kRadian},
                           UnitRow{"\xC2\xB0", "angle", kRadian},
                           UnitRow{"N", "force"},
                           UnitRow{"mN", "force", 1e-3},
                           UnitRow{"kN", "force", 1e3},
                           UnitRow{"kgf", "force", kGravity},
                           UnitRow{"gf", "force", 1e-3 * kGravity},
                           UnitRow{"lbf", "force", kPoundForce},
                           UnitRow{"kip", "force", 1e3 * kPoundForce},
                           UnitRow{"Nm", "torque"},
                           UnitRow{"mNm", "torque", 1e-3},
                           UnitRow{"kNm", "torque", 1e3},
                           UnitRow{"Nmm", "torque", 1e-3},
                           UnitRow{"Ncm", "torque", 1e-2},
                           UnitRow{"lbfin", "torque", kPoundForce* kInch},
                           UnitRow{"lbfft", "torque", 12.0 * kPoundForce* kInch},
                           UnitRow{"m/s", "velocity"},
                           UnitRow{"mm/s", "velocity", 1e-3},
                           UnitRow{"cm/s", "velocity", 1e-2},
                           UnitRow{"in/s", "velocity", kInch},
                           UnitRow{"rad/s", "rate"},
                           UnitRow{"deg/s", "rate", kRadian},
                           UnitRow{"dps", "rate", kRadian},
                           UnitRow{"rpm", "rate", std::numbers::pi / 30.0},
                           UnitRow{"rev", "angle", 2.0 * std::numbers::pi},
                           UnitRow{"rev/s", "rate", 2.0 * std::numbers::pi},
                           UnitRow{"turns/s", "rate", 2.0 * std::numbers::pi},
                           UnitRow{"m/s2", "acceleration"},
                           UnitRow{"mm/s2", "acceleration", 1e-3},
                           UnitRow{"g", "acceleration", kGravity},
                           UnitRow{"rad/s2", "angular acceleration"},
                           UnitRow{"deg/s2", "angular acceleration", kRadian},
                           UnitRow{"degC", "temperature"},
                           UnitRow{"C", "temperature"},
                           UnitRow{"\xC2\xB0"
                                   "C",
                                   "temperature"},
                           UnitRow{"K", "temperature", 1.0, -273.15},
                           UnitRow{"degF", "temperature", 5.0 / 9.0, -160.0 / 9.0},
                           UnitRow{"Pa", "pressure"},
                           UnitRow{"kPa", "pressure", 1e3},
                           UnitRow{"MPa", "pressure", 1e6},
                           UnitRow{"mbar", "pressure", 1e2},
                           UnitRow{"bar", "pressure", 1e5},
                           UnitRow{"psi", "pressure", kPoundForce / (kInch * kInch)},
                           UnitRow{"W", "power"},
                           UnitRow{"V", "voltage"},
                           UnitRow{"mV", "voltage", 1e-3},
                           UnitRow{"A", "current"},
                           UnitRow{"mA", "current", 1e-3},
                           UnitRow{"1", "number"},
                           UnitRow{"-", "number"},
                           UnitRow{"#", "number"},
                           UnitRow{"counts", "counts"},
                           UnitRow{"count", "counts"},
                           UnitRow{"lsb", "counts"},
                           UnitRow{"ticks", "counts"}};

/// Units written out, in any case, with or without an s behind.
constexpr std::array<std::pair<std::string_view, const char*>, 17> kWrittenOut = {
    {{"radian", "rad"},
     {"meter", "m"},
     {"metre", "m"},
     {"millimeter", "mm"},
     {"millimetre", "mm"},
     {"centimeter", "cm"},
     {"centimetre", "cm"},
     {"newton", "N"},
     {"millinewton", "mN"},
     {"newtonmeter", "Nm"},
     {"newtonmetre", "Nm"},
     {"millisecond", "ms"},
     {"microsecond", "us"},
     {"rpm", "rpm"},
     {"turn", "rev"},
     {"revolution", "rev"},
     {"nanosecond", "ns"}}};

/// "N*m", "N.m", "N m", "N·m" are "Nm"; "m/s^2" and "m/s²" are "m/s2".
std::string plain(std::string_view unit) {
  std::string out;
  for (std::size_t k = 0; k < unit.size(); ++k) {
    if (unit.substr(k, 2) == "\xC2\xB2") {
      out += '2', ++k;
    } else if (unit.substr(k, 2) == "\xC2\xB7") {
      ++k;
    } else if (unit.substr(k, 3) == "\xE2\x8B\x85") {
      k += 2;
    } else if (unit[k] != '*' && unit[k] != '.' && unit[k] != ' ' && unit[k] != '^') {
      out += unit[k];
    }
  }
  return out;
}

std::string abbreviated(const std::string& unit) {
  std::string word;
  for (const char c : unit) {
    word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (word.ends_with('s')) word.pop_back();
  for (const auto& [whole, short_unit] : kWrittenOut) {
    if (word == whole) return short_unit;
  }
  return unit;
}

/// Where the unit in brackets, behind '/' or behind the last '_' begins and the name ends.
struct Parts {
  std::string_view name, unit;
};

Parts parts_of(std::string_view name) {
  name = trimmed(name);
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const std::size_t at = name.rfind(open);
    if (at == std::string_view::npos || name.back() != close) continue;
    const std::string_view unit = name.substr(at + 1, name.size() - at - 2);
    // position[3] and position[elbow] are elements of an array.
    if (find_unit(unit) && !unit.empty() && unit != "1") return {trimmed(name.substr(0, at)), unit};
  }
  constexpr std::array<std::string_view, 25> kBehindMark = {
      "s",   "ms",  "us",  "ns",  "sec",   "nsec",  "mm",   "cm", "rad", "deg",    "N", "mN", "Nm",
      "mNm", "kgf", "mps", "m/s", "rad/s", "deg/s", "degC", "n",  "nm",  "counts", "m", "rpm"};
  for (const char mark : {'/', '_'}) {
    const std::size_t at = name.rfind(mark);
    if (at == std::string_view::npos || at == 0) continue;
    const std::string_view unit = name.substr(at + 1);
    if (std::find(kBehindMark.begin(), kBehindMark.end(), unit) == kBehindMark.end()) continue;
    if (unit == "n") return {name.substr(0, at), "N"};
    if (unit == "nm") return {name.substr(0, at), "Nm"};
    if (unit == "mps") return {name.substr(0, at), "m/s"};
    return {name.substr(0, at), unit};
  }
  return {name, ""};
}

}  // namespace

std::optional<LogUnit> find_unit(std::string_view unit) {
  const std::string wanted = abbreviated(plain(unit));
  for (const UnitRow& row : kUnits) {
    if (wanted == row.unit) return LogUnit{row.quantity, row.factor, row.origin};
  }
  return std::nullopt;
}

std::string units_of(const std::string& quantity) {
  std::string list;
  for (const UnitRow& row : kUnits) {
    if (!quantity.empty() && quantity != row.quantity) continue;
    list += (list.empty() ? "" : ", ") + std::string(row.unit);
  }
  return list;
}

std::string si_unit_of(const std::string& quantity) {
  const auto* si = std::find_if(kUnits.begin(), kUnits.end(), [&](const UnitRow& row) {
    return quantity == row.quantity && row.factor == 1.0;
  });
  return si == kUnits.end() ? "" : si->unit;
}

std::string unit_of_name(std::string_view name) { return std::string(parts_of(name).unit); }

std::string unknown_unit_of_name(std::string_view name) {
  name = trimmed(name);
  if (name.empty() || !parts_of(name).unit.empty()) return "";
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const std::size_t at = name.rfind(open);
    if (at == std::string_view::npos || at == 0 || name.back() != close) continue;
    if (open == '[' && name[at - 1] != ' ') continue;  // an element of an array
    const std::string_view inside = trimmed(name.substr(at + 1, name.size() - at - 2));
    const bool letters = std::any_of(inside.begin(), inside.end(),
                                     [](unsigned char c) { return std::isalpha(c) != 0; });
    if (letters) return std::string(inside);
  }
  return "";
}

std::string name_without_unit(std::string_view name) { return std::string(parts_of(name).name); }

}  // namespace dcnn
