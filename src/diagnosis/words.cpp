#include "diagnosis/words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/effect_words.h"

namespace dcnn {
namespace {

using Estimates = std::vector<Estimate>;

bool is_told_of(const std::vector<Estimate>& numbers, const char* name) {
  return std::all_of(numbers.begin(), numbers.end(), [&](const Estimate& number) {
    return number.name != name || is_told({{"ci95", {number.low, number.high}}});
  });
}

double value_of(const Estimates& numbers, const std::string& name) {
  for (const Estimate& e : numbers) {
    if (e.name == name) return e.value;
  }
  return 0.0;
}

/// Length of a vector among the numbers: all whose names begin so and end so.
double length_of(const Estimates& numbers, const std::string& begin, const std::string& end) {
  double square = 0.0;
  for (const Estimate& e : numbers) {
    if (e.name.starts_with(begin) && e.name.ends_with(end)) square += e.value * e.value;
  }
  return std::sqrt(square);
}

std::string place(const std::string& axis) { return axis.empty() ? "" : " " + words_of_axis(axis); }

std::string milli(double value, const char* unit) { return brief(1e3 * value) + " " + unit; }

std::string force(double newtons) {
  const bool small = std::abs(newtons) < 0.01;
  return small ? milli(newtons, "mN") : brief(newtons) + " N";
}

std::string torque(double newton_metres) {
  const bool small = std::abs(newton_metres) < 0.01;
  return small ? milli(newton_metres, "mN·m") : brief(newton_metres) + " N·m";
}

/// "0.3 N", "0.3 N and 12 mN·m" or "12 mN·m", whichever are among the numbers that begin so.
std::string push(const Estimates& n, const std::string& begin, const std::string& per = "",
                 double times = 1.0) {
  const double f = times * length_of(n, begin, "_n" + per),
               t = times * length_of(n, begin, "_nm" + per);
  if (t == 0.0) return force(f);
  return f == 0.0 ? torque(t) : force(f) + " and " + torque(t);
}

/// ", at y = -35 mm, z = 158 mm from the sensor's origin", where torques tell of it.
std::string lever(const Estimates& n) {
  std::string at;
  for (const Estimate& e : n) {
    if (!e.name.starts_with("lever_") || e.low == e.high) continue;
    at += (at.empty() ? ", at " : ", ") + e.name.substr(6, 1) + " = " + milli(e.value, "mm");
  }
  return at.empty() ? at : at + " from the sensor's origin";
}

std::string mass(double kg) { return std::abs(kg) < 1.0 ? milli(kg, "g") : brief(kg) + " kg"; }

std::string seconds(double t) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", t);
  return text;
}

/// " from 12.3 to 14.0 s of fit.csv"; nothing for what acts all the time.
std::string when(const Member& member) {
  if (!member.interval_s) return "";
  const auto [begin, end] = *member.interval_s;
  const bool onset = member.kind->interval == IntervalRule::kOnset;
  return (onset ? " at " + seconds(begin) : " from " + seconds(begin) + " to " + seconds(end)) +
         " s" + (member.recording.empty() ? "" : " of " + member.recording);
}

/// Of a law that a logged signal drives.
std::string driven_in_words(const Member& member, const Estimates& n) {
  const auto& [signal, low, high] = *member.driver;
  return driven_words(*member.kind, place(member.axis),
                      {signal, unit_text(unit_of_parameter(member.kind->strength)), low, high,
                       member.amplitudes(0), member.amplitudes(1), value_of(n, "lag_s")});
}

std::string effect_in_words(const Member& member, const Estimates& n) {
  const std::string id = member.name(), where = place(member.axis);
  const auto number = [&](const char* name) { return brief(value_of(n, name)); };
  if (id == "mass") {
    const double d = value_of(n, "delta_mass_kg");
    return "the tool is " + mass(std::abs(d)) + (d > 0 ? " heavier" : " lighter") +
           " than simulated";
  }
  if (id == "com")
    return "the centre of mass is " + milli(length_of(n, "delta_com", "_m"), "mm") +
           " away from where it is simulated";
  if (id == "gravity_tilt")
    return "the robot's base is tilted by " + milli(length_of(n, "tilt", "_rad"), "mrad");
  if (id == "inertial_terms")
    return "the simulation leaves out inertial terms that the recordings show";
  if (id == "weightless_mass")
    return "the inertia of " + mass(value_of(n, "mass_kg")) + " whose weight is compensated";
  if (id == "coulomb_friction") return "dry friction of " + number("fc_n") + " N" + where;
  if (id == "viscous_friction") return "viscous friction of " + number("c_nspm") + " N·s/m" + where;
  if (id == "stribeck_friction")
    return "friction that falls from " + number("fs_n") + " to " + number("fc_n") +
           " N with speed" + where;
  if (id == "quadratic_drag") return "drag of " + number("c2_ns2pm2") + " N·s²/m²" + where;
  if (id == "lugre_friction")
    return is_told_of(n, "sigma0_npm")
               ? "friction of " + number("fc_n") + " N that first gives way elastically" + where
               : "dry friction of " + number("fc_n") + " N" + where;
  if (id == "load_friction")
    return "friction of " + brief(100.0 * value_of(n, "mu")) + " % of the load across the path" +
           where;
  if (id == "creep")
    return "the sensor goes on settling after a load, by " + brief(100.0 * value_of(n, "a")) +
           " % within " + number("tau_s") + " s";
  if (id == "hysteresis")
    return "a cable with hysteresis of " + brief(std::abs(value_of(n, "force_n"))) + " N" + where;
  if (id == "cable_spring")
    return "a cable or hose that pulls with " + number("k_nprad") + " N/rad" + where;
  if (id == "cogging")
    return "a force of " + number("amp_n") + " N that repeats " + number("order") +
           " times a turn" + where;
  if (id == "loose_load")
    return "a part of about " + milli(value_of(n, "slug_kg"), "g") + " that slides between stops" +
           where;
  if (id == "flexible_resonance") return "the tool rings at " + number("freq_hz") + " Hz" + where;
  if (id == "contact") return "a contact of " + push(n, "force") + when(member);
  if (id == "bias") return "a constant offset of " + push(n, "delta_bias");
  if (id == "misalignment")
    return "the sensor's axes are turned by " + milli(length_of(n, "rot", "_rad"), "mrad");
  if (id == "gain")
    return "the sensor's scale is off by up to " +
           brief(100.0 * std::max({std::abs(value_of(n, "gain_x")), std::abs(value_of(n, "gain_y")),
                                   std::abs(value_of(n, "gain_z"))})) +
           " %";
  if (id == "crosstalk")
    return "the sensor's axes leak into each other, by " + brief(100.0 * length_of(n, "c_", "")) +
           " % in all";
  if (id == "time_delay")
    return std::string("the force ") + (value_of(n, "delay_s") < 0.0 ? "leads" : "lags") +
           " the pose by " + milli(std::abs(value_of(n, "delay_s")), "ms");
  if (id == "lowpass")
    return "the sensor smooths with a time constant of " + milli(value_of(n, "tau_s"), "ms");
  if (id == "thermal_drift") return "the sensor's offset drifts with its temperature";
  if (id == "linear_drift")
    return "the sensor's offset grows by " + push(n, "rate", "ps", 60.0) + " a minute";
  if (id == "step_bias") return "the sensor's offset jumps by " + push(n, "step") + when(member);
  if (id == "saturation") return "the reading is clipped at " + number("limit_n") + " N" + where;
  if (id == "quantisation") return "the reading comes in steps of " + force(value_of(n, "step_n"));
  if (id == "hum") {
    Estimates both = n;  // of sine and cosine as of one vector
    for (Estimate& e : both) {
      if (e.name != "freq_hz") e.name = "wave_" + e.name;
    }
    return "a hum of " + push(both, "wave") + " at " + number("freq_hz") + " Hz";
  }
  return std::string(member.kind->meaning) + where;
}

}  // namespace

std::string driven_words(const EffectKind& kind, const std::string& place, const Following& law) {
  const auto at = [&](double strength, double value) {
    return brief(strength) + (law.unit.empty() ? "" : " " + law.unit) + " at " + brief(value);
  };
  const bool offset = kind.stage == Stage::kOffset;
  std::string text = (offset ? "offset" : kind.meaning) + place + " that follows " + law.signal +
                     ", " + at(law.at_low, law.low) + " and " + at(law.at_high, law.high);
  if (law.lag == 0.0) return text;
  const std::string away = milli(std::abs(law.lag), "ms");
  return text + ", " + away + (law.lag > 0.0 ? " after it" : " before it");
}

std::string per_signal(const std::string& unit, const Json& driven_by) {
  return (unit.empty() ? "1" : unit) + " per unit of " + driven_by["value"].get<std::string>();
}

std::string in_words(const Member& member, const Estimates& n) {
  return (member.driver ? driven_in_words(member, n) : effect_in_words(member, n)) + lever(n);
}

}  // namespace dcnn
