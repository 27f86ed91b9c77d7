// SPDX-License-Identifier: Apache-2.0
// A law in files: its structure, its numbers, and their names and units.
#include <algorithm>
#include <cmath>

#include "dcnn/physics/law.h"
#include "physics/effect_law.h"
#include "physics/law/factor_text.h"

namespace dcnn::law {
namespace {

const std::vector<std::string> kMemories{"none", "lag",   "high_pass",    "play",  "dahl",
                                         "stop", "dwell", "second_order", "delay", "thixotropic",
                                         "lags", "plays", "uneven_lag"};
constexpr std::size_t kMostFactors = 4;
const std::vector<std::string> kToldAgain{"expression", "latex", "words", "coordinates", "states"};

template <class List>
std::vector<std::string> names_in(const List& list) {
  std::vector<std::string> names;
  for (const auto& entry : list) {
    if (!std::string(entry.name).empty()) names.emplace_back(entry.name);
  }
  return names;
}

/// Place of a word that must be in the list.
template <class List>
std::size_t place_in(Options& options, const std::string& key, const List& list) {
  const auto names = names_in(list);
  const auto word = options.get<std::string>(key);
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& entry) { return entry.name == word; });
  if (found == list.end() || word.empty()) {
    const auto near = nearest_word(word, names);
    options.reject(key, "'", word, "' is unknown",
                   near.empty() ? "; docs/use/diagnose.md lists the words of laws"
                                : "; did you mean '" + near + "'?");
  }
  return static_cast<std::size_t>(found - list.begin());
}

/// Columns of the recordings.
std::vector<std::string> parse_signals(Options& options) {
  if (!options.has("signals")) return {};
  const Json list = options.raw("signals");
  const bool is_list = list.is_array() && list.size() <= kMostSignals &&
                       std::all_of(list.begin(), list.end(), [](const Json& name) {
                         return name.is_string() && !name.get<std::string>().empty();
                       });
  if (!is_list) options.reject("signals", "must be a list of at most ", kMostSignals, " columns");
  return list.get<std::vector<std::string>>();
}

/// `terms` have the names of coordinates() for signals: a column may be called as a coordinate is.
Factor parse_factor(Options options, const Terms& terms) {
  Factor factor;
  factor.shape = place_in(options, "shape", shapes());
  factor.coordinate = place_in(options, "of", terms.coordinates);
  const auto memory = options.choice("memory", kMemories[0], kMemories);
  factor.memory = static_cast<Memory>(std::find(kMemories.begin(), kMemories.end(), memory) -
                                      kMemories.begin());
  factor.remembered = options.get<bool>("remembered", false);
  if (factor.remembered && !is_of_time(factor.memory)) {
    options.reject("remembered", "needs a memory of time, as lag, not '", memory, "'");
  }
  factor.centred = options.get<bool>("centred", false);
  if (is_curve(factor.shape)) {
    const auto count = [&](const char* key, std::size_t least, std::size_t most) {
      const int value = options.get<int>(key);
      if (value < static_cast<int>(least) || value > static_cast<int>(most)) {
        options.reject(key, "must lie in ", least, " to ", most, ", not ", value);
      }
      return static_cast<std::size_t>(value);
    };
    factor.nodes = count("nodes", kFewestNodes, kMostNodes);
    factor.peak = count("peak", 0, factor.nodes - 1);
  }
  options.finish();
  return factor;
}

/// "_mps" of "m/s": how a unit ends a parameter's name.
std::string suffix_of(const std::string& unit) {
  if (unit == "m/s") return "_mps";
  if (unit == "rad/s") return "_radps";
  if (unit == "m/s^2") return "_mps2";
  if (unit == "rad/s^2") return "_radps2";
  if (unit == "m^2/s^2") return "_m2ps2";
  if (unit == "N") return "_n";
  if (unit == "Hz") return "_hz";
  return unit.empty() ? "" : "_" + unit;
}

void add_numbers(const Factor& factor, const std::string& index, const Terms& terms,
                 std::vector<Number>& list) {
  const Coordinate& q = terms.coordinates[factor.coordinate];
  const Shape& shape = shapes()[factor.shape];
  const auto add = [&](const std::string& stem, const std::string& unit, bool reference, double low,
                       double high) {
    // Parameters of a machine's axis do not end in units, which the description gives.
    const std::string suffix = terms.axis.empty() ? suffix_of(unit) : "";
    list.push_back({stem + index + suffix, unit, reference, low, high});
  };
  if (factor.memory != Memory::kNone) add("memory_", memory_unit(factor, q), false, 1e-9, 1e9);
  if (factor.memory == Memory::kSecondOrder) {
    add("damping_", "", false, kLeastDamping, kMostDamping);
  }
  if (factor.memory == Memory::kThixotropic) add("recovery_", "s", false, 1e-4, 1e5);
  if (factor.memory == Memory::kUnevenLag) add("falling_", "s", false, 1e-9, 1e9);
  if (factor.memory == Memory::kLags) add("spread_", "", false, 1.0, kMostSpread);
  const std::string unit = state_unit(factor, q);
  if (factor.centred) add("centre_", unit, !shape.free_centre, -1e9, 1e9);
  add("scale_", unit, !shape.free_scale, shape.signed_scale ? -1e9 : 1e-9, 1e9);
  if (*shape.extra) add(std::string(shape.extra) + "_", "", false, shape.least, shape.most);
  for (std::size_t k = 0; k < factor.nodes; ++k) {
    list.push_back(
        {"value_" + index + "_" + std::to_string(k + 1), "", k == factor.peak, -1e6, 1e6});
  }
}

/// A coordinate of the law's own direction needs one: a unit axis, or for `distance` a point.
void refuse_without_axis(Options& options, const Structure& structure, std::size_t coordinate) {
  if (!is_own(coordinate)) return;
  const bool central = is_central(structure.direction);
  const std::string name = coordinates()[coordinate].name;
  if (name == "distance" ? central : central || is_axis(structure.direction)) return;
  options.reject("factors", "'", name, "' needs ",
                 name == "distance" ? "the axis from_point" : "an axis of sensor, tool or base",
                 ", not '", directions()[structure.direction].name, "'");
}

/// Of an oblique axis, or of a point.
void add_own_numbers(const Structure& structure, std::vector<Number>& list) {
  const char* const names[] = {"x", "y", "z"};
  if (is_central(structure.direction)) {
    for (const char* name : names) {
      list.push_back({std::string("point_") + name + "_m", "m", false, -1e6, 1e6});
    }
  } else if (structure.oblique) {
    for (const std::size_t next : {1, 2}) {
      const std::string name = names[(structure.direction + next) % 3];
      list.push_back({"axis_" + name, "", false, -1e6, 1e6});
    }
  }
}

Json factor_json(const Factor& factor, const Coordinate& q) {
  const bool signal = is_signal(factor.coordinate);
  Json json{{"shape", shapes()[factor.shape].name},
            {"of", signal ? coordinates()[factor.coordinate].name : q.name}};
  if (factor.memory != Memory::kNone) {
    json["memory"] = kMemories[static_cast<std::size_t>(factor.memory)];
  }
  if (factor.remembered) json["remembered"] = true;
  if (factor.centred) json["centred"] = true;
  if (is_curve(factor.shape)) json["nodes"] = factor.nodes, json["peak"] = factor.peak;
  return json;
}

}  // namespace

Structure parse_structure(Options& options, const Terms& terms) {
  Structure structure;
  structure.direction =
      terms.axis.empty() ? place_in(options, "axis", directions()) : drive_direction();
  structure.direction_lagged = options.get<bool>("direction_lagged", false);
  structure.presliding = options.get<bool>("direction_presliding", false);
  structure.lagged = options.get<bool>("lagged", false);
  structure.spread = options.get<bool>("lag_spread", false);
  structure.on_torque = options.get<bool>("on_torque", false);
  structure.oblique = terms.axis.empty() && options.get<bool>("oblique", false);
  if (structure.oblique && !has_axis(structure.direction)) {
    options.reject("oblique", "is of axes, not of '", directions()[structure.direction].name, "'");
  }
  const std::string axis = directions()[structure.direction].name;
  if (structure.presliding && (axis != "along_velocity" || structure.direction_lagged)) {
    options.reject("direction_presliding", "is of the axis along_velocity without a lag");
  }
  if (structure.spread && !structure.lagged) options.reject("lag_spread", "needs 'lagged'");
  structure.signals = parse_signals(options);
  std::vector<std::string> slots;
  for (std::size_t k = 0; k < structure.signals.size(); ++k) {
    slots.push_back(coordinates()[signal_coordinate(k)].name);
  }
  const Terms here = with_signals(terms, slots);
  const Json factors = options.raw("factors");
  if (!factors.is_array() || factors.size() > kMostFactors) {
    options.reject("factors", "must be a list of at most ", kMostFactors, " factors, not ",
                   factors.dump());
  }
  for (std::size_t k = 0; k < factors.size(); ++k) {
    structure.factors.push_back(parse_factor(
        Options(factors[k], "law: factor " + std::to_string(k + 1), Exit::kData), here));
    refuse_without_axis(options, structure, structure.factors.back().coordinate);
  }
  const bool changes = !structure.factors.empty() || structure.direction_lagged;
  if (!changes && is_axis(structure.direction)) {
    options.reject("factors", "must not be empty: a constant force is the effect bias or contact");
  }
  for (const auto& key : kToldAgain) options.raw(key);
  options.raw("established");
  options.raw("rivals");
  options.finish();
  return structure;
}

std::vector<Number> numbers_of(const Structure& structure, const Terms& terms) {
  std::vector<Number> list;
  if (structure.on_torque) {
    list.push_back({"amplitude_nm", "N*m", false, -1e9, 1e9});
  } else {
    list.push_back(
        {terms.axis.empty() ? "amplitude_n" : "amplitude", terms.force, false, -1e9, 1e9});
  }
  const std::string vector = directions()[structure.direction].unit;
  if (!vector.empty()) {
    list.push_back({"vector_scale" + suffix_of(vector), vector, true, 1e-9, 1e9});
  }
  add_own_numbers(structure, list);
  if (structure.direction_lagged) list.push_back({"vector_lag_s", "s", false, 1e-4, 1e5});
  if (structure.presliding) list.push_back({"vector_length_m", "m", false, 1e-9, 1e6});
  if (structure.lagged) list.push_back({"lag_s", "s", false, 1e-4, 1e5});
  if (structure.spread) list.push_back({"lag_spread", "", false, 1.0, kMostSpread});
  for (std::size_t k = 0; k < structure.factors.size(); ++k) {
    add_numbers(structure.factors[k], std::to_string(k + 1), terms, list);
  }
  return list;
}

Law parse_law(const Structure& structure, Options& parameters, const Terms& terms) {
  const auto list = numbers_of(structure, terms);
  Law law{structure, Eigen::VectorXd(static_cast<Eigen::Index>(list.size()))};
  for (std::size_t k = 0; k < list.size(); ++k) {
    const double value = parameter(parameters, list[k].name, list[k].low, list[k].high);
    if (list[k].name.starts_with("scale_") && value == 0.0) {
      parameters.reject(list[k].name, "must not be 0");
    }
    law.numbers(static_cast<Eigen::Index>(k)) = value;
  }
  return law;
}

Json parameters_json(const Law& law, const Terms& terms) {
  const auto list = numbers_of(law.structure, terms);
  Json json = Json::object();
  for (std::size_t k = 0; k < list.size(); ++k) {
    json[list[k].name] = law.numbers(static_cast<Eigen::Index>(k));
  }
  return json;
}

Json to_json(const Law& law, const Terms& terms) {
  const Structure& structure = law.structure;
  Json json = Json::object();
  if (terms.axis.empty()) json["axis"] = directions()[structure.direction].name;
  if (structure.oblique) json["oblique"] = true;
  if (structure.direction_lagged) json["direction_lagged"] = true;
  if (structure.presliding) json["direction_presliding"] = true;
  if (structure.lagged) json["lagged"] = true;
  if (structure.spread) json["lag_spread"] = true;
  if (structure.on_torque) json["on_torque"] = true;
  if (!structure.signals.empty()) json["signals"] = structure.signals;
  const Terms here = with_signals(terms, structure.signals);
  Json factors = Json::array(), used = Json::array(), states = Json::array();
  for (std::size_t k = 0; k < structure.factors.size(); ++k) {
    const Factor& factor = structure.factors[k];
    const Coordinate& q = here.coordinates[factor.coordinate];
    factors.push_back(factor_json(factor, q));
    used.push_back(Json{{"name", q.name}, {"frame", q.frame}, {"unit", q.unit}});
    if (factor.memory == Memory::kNone) continue;
    states.push_back(Json{{"name", "s_" + std::to_string(k + 1)},
                          {"kind", kMemories[static_cast<std::size_t>(factor.memory)]},
                          {"of", q.name},
                          {"unit", factor.remembered ? "" : state_unit(factor, q)}});
  }
  json["factors"] = factors;
  json["expression"] = expression(law, terms);
  json["latex"] = latex(law, terms);
  json["words"] = words(law, terms);
  json["coordinates"] = used;
  json["states"] = states;
  return json;
}

}  // namespace dcnn::law
