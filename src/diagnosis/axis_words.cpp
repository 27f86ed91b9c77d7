#include "diagnosis/axis_words.h"

#include <cmath>
#include <functional>
#include <map>

#include "core/elementary.h"
#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/effect.h"
#include "dcnn/physics/effect_words.h"
#include "diagnosis/plain_findings.h"
#include "diagnosis/words.h"

namespace dcnn {
namespace {

/// The numbers of a finding, ready to be written.
class Numbers {
 public:
  Numbers(const Json& parameters, const Axis& axis)
      : parameters_(parameters), turns_(axis.position_unit == "rad") {}
  bool of_a_turn() const { return turns_; }
  bool has(const char* name) const { return parameters_.contains(name); }
  double value(const char* name) const { return parameters_[name]["value"].get<double>(); }
  std::string operator()(const char* name, double factor = 1.0) const {
    return brief(factor * value(name)) + " " + unit(name);
  }
  std::string plain(const char* name, double factor = 1.0) const {
    return brief(factor * value(name));
  }
  bool told(const char* name) const { return is_told(parameters_[name]); }
  std::string unit(const char* name) const { return parameters_[name]["unit"]; }
  /// Without its sign, times a factor; over another unit.
  std::string size(const char* name, double factor = 1.0, const std::string& per = "") const {
    return brief(factor * std::abs(value(name))) + " " + unit(name) +
           (per.empty() ? "" : "/" + per);
  }
  /// Whether the 95 % interval of a number holds a value.
  bool holds(const char* name, double at) const {
    const Json& ends = parameters_[name]["ci95"];
    return ends[0].is_number() && ends[0].get<double>() <= at && ends[1].get<double>() >= at;
  }

 private:
  const Json& parameters_;
  bool turns_;
};

/// By the force at which Bouc-Wen's law settles, 1/(beta + gamma)^(1/m) of its scale, which is none
/// where its 95 % interval does not say that the law settles: then by its stiffness after a turn.
std::string hysteresis_words(const Numbers& n) {
  if (!n.has("beta")) return "hysteresis of " + n.size("force");
  const double beta = n.value("beta"), rate = beta + n.value("gamma");
  if (rate > 0.0 && !n.holds("gamma", -beta)) {
    return "hysteresis of " + n.size("force", elementary::pow(rate, -1.0 / n.value("m")));
  }
  return "hysteresis that grows by " + n.size("force", 1.0 / n.value("width"), n.unit("width")) +
         " after a turn back";
}

/// A force that repeats with the position: once a turn, as that of a weight on a turning axis does.
std::string cogging_words(const Numbers& n) {
  if (n.of_a_turn() && n.holds("order", 1.0)) {
    return "a force of " + n.size("amp") +
           " that goes with the sine of the position, as the weight of a load off its axis";
  }
  return "cogging of " + n.size("amp") + " that repeats with order " + n.plain("order");
}

using Sentence = std::function<std::string(const Numbers&)>;

const std::map<std::string, Sentence>& sentences() {
  static const std::map<std::string, Sentence> kSentences{
      {"coulomb_friction", [](auto& n) { return "dry friction of " + n("fc"); }},
      {"viscous_friction", [](auto& n) { return "viscous friction of " + n("c"); }},
      {"stribeck_friction",
       [](auto& n) {
         return "friction that falls from " + n("fs") + " to " + n("fc") + " with speed";
       }},
      {"quadratic_drag", [](auto& n) { return "drag of " + n("c2"); }},
      {"lugre_friction",
       [](auto& n) {
         return n.told("sigma0") ? "friction of " + n("fc") + " that first gives way elastically"
                                 : "dry friction of " + n("fc");
       }},
      {"asymmetric_friction",
       [](auto& n) {
         return "friction that differs between the directions, by " + n.size("delta_c") +
                " either way";
       }},
      {"load_friction",
       [](auto& n) { return "friction of " + n.plain("mu", 100.0) + " % of what is transmitted"; }},
      {"gear_friction",
       [](auto& n) {
         return "dry friction of " + n("fc") + " that varies by " + n.plain("a", 100.0) +
                " % with order " + n.plain("order") + " of the position";
       }},
      {"hysteresis", hysteresis_words},
      {"cable_spring", [](auto& n) { return "a spring of " + n("k"); }},
      {"quadratic_spring",
       [](auto& n) { return "a spring that bends with the square of the position, " + n("k2"); }},
      {"creep",
       [](auto& n) {
         return "a reading that goes on settling by " + n.plain("a", 100.0) + " % within " +
                n("tau");
       }},
      {"cubic_spring",
       [](auto& n) { return "a spring that stiffens with the cube of the position, " + n("k3"); }},
      {"cogging", cogging_words},
      {"inertia", [](auto& n) { return "an inertia that is off by " + n("delta_inertia"); }},
      {"contact", [](auto& n) { return "an external force of " + n("force"); }},
      {"bias", [](auto& n) { return "a constant offset of " + n("delta_bias"); }},
      {"gain", [](auto& n) { return "a scale that is off by " + n.plain("gain", 100.0) + " %"; }},
      {"time_delay",
       [](auto& n) {
         const std::string size = brief(1e3 * std::abs(n.value("delay"))) + " ms";
         return n.value("delay") < 0.0 ? "a lead of " + size + " before the position"
                                       : "a delay of " + size + " after the position";
       }},
      {"lowpass",
       [](auto& n) { return "a lag with a time constant of " + n.plain("tau", 1e3) + " ms"; }},
      {"thermal_drift",
       [](auto& n) {
         return n.has("k") ? "an offset that follows the temperature with " + n("k")
                           : "an offset that settles by " + n("a") + " within " + n("tau");
       }},
      {"linear_drift", [](auto& n) { return "an offset that grows by " + n("rate"); }},
      {"step_bias", [](auto& n) { return "an offset that jumps by " + n("step"); }},
      {"saturation", [](auto& n) { return "a reading that is clipped at " + n("limit"); }},
      {"quantisation", [](auto& n) { return "a reading in steps of " + n("step"); }},
      {"flexible_resonance", [](auto& n) { return "a resonance at " + n("freq"); }},
      {"hum", [](auto& n) { return "a hum at " + n("freq"); }}};
  return kSentences;
}

}  // namespace

std::string axis_words(const Json& finding, const Axis& axis, const std::string& strength) {
  const std::string id = finding["effect"];
  const Json& numbers = finding["parameters"];
  if (numbers.contains("driven_by")) {
    const auto low = finding["driven_over"][0].get<double>(),
               high = finding["driven_over"][1].get<double>();
    const auto at = [&](double s) {
      return numbers[strength]["value"].get<double>() + s * numbers["slope"]["value"].get<double>();
    };
    return driven_words(*find_effect(id), "",
                        {numbers["driven_by"]["value"], unit_text(numbers[strength]["unit"]), low,
                         high, at(low), at(high), numbers["lag"]["value"]}) +
           " on " + axis.name;
  }
  if (is_constant(finding)) return constant_words(finding) + " on " + axis.name;
  const auto sentence = sentences().find(id);
  const std::string what = sentence == sentences().end()
                               ? words_of_effect(id, axis.name)
                               : sentence->second(Numbers(finding["parameters"], axis));
  return what + " on " + axis.name;
}

}  // namespace dcnn
