// SPDX-License-Identifier: Apache-2.0
#include "import/joint_names.h"

#include <algorithm>
#include <initializer_list>

namespace dcnn {
namespace {

using Words = std::vector<std::string>;

bool stands_in(const std::string& word, std::initializer_list<const char*> list) {
  return std::any_of(list.begin(), list.end(), [&](const char* other) { return word == other; });
}

bool is_number(const std::string& word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
}

/// A word without the digits behind it: "joint3" is "joint".
std::string stem_of(const std::string& word) {
  const std::size_t last = word.find_last_not_of("0123456789");
  return last == std::string::npos ? "" : word.substr(0, last + 1);
}

std::string quantity_of(const std::string& stem) {
  if (stands_in(stem, {"q", "pos", "position", "positions", "angle", "angles", "theta"}))
    return "q:";
  if (stem == "aipos") return "q:";  // KUKA RSI: actual positions of the axes
  if (stands_in(stem,
                {"qd", "dq", "qdot", "vel", "velocity", "velocities", "speed", "speeds", "omega"}))
    return "qd:";
  if (stands_in(stem, {"tau", "torque", "torques", "effort", "efforts", "eff", "trq"}))
    return "tau:";
  return "";
}

/// A motor's current; "current" may also say that a position is the present one.
bool is_current(const std::string& stem) {
  return stands_in(stem, {"current", "currents", "curr", "cur", "iq", "macur"});
}

bool is_joint_word(const std::string& stem) {
  return stands_in(stem, {"joint", "joints", "jnt", "j", "axis"});
}

/// Quantities that no column of a joint is, and what is no joint.
bool is_foreign(const std::string& stem) {
  return stands_in(
      stem, {"qdd",      "ddq", "acc",      "acceleration", "error",  "err",     "offset",
             "limit",    "min", "max",      "twist",        "linear", "angular", "wrench",
             "force",    "ee",  "tcp",      "tool",         "base",   "imu",     "wheel",
             "external", "ext", "friction", "coriolis",     "rigid",  "model",   "temperature"});
}

bool says_nothing(const std::string& word) {
  return stands_in(
      word, {"actual", "act", "measured", "meas", "msr", "state", "states", "current", "field", "motor",
             "feedback", "fb", "data", "disturb", "disturbance", "value"});
}

/// "joint_3" and "joint3" are joint 3; "panda_joint3" is a name of its own.
std::string plain_joint(std::string name) {
  const std::size_t digit = name.find_first_of("0123456789");
  if (digit == std::string::npos || !is_number(name.substr(digit))) return name;
  std::string stem = name.substr(0, digit);
  if (stem == "a" || stem.ends_with("_a")) stem.pop_back();  // axes A1 to A6
  if (stem.ends_with('_')) stem.pop_back();
  return stem.empty() || is_joint_word(stem) ? name.substr(digit) : name;
}

}  // namespace

std::string joint_quantity_of_file(const Words& words) {
  std::string found;
  for (const std::string& word : words) {
    std::string kind = quantity_of(stem_of(word));
    if (stands_in(word, {"tor", "torq", "curr", "current", "currents"})) kind = "tau:";
    if (kind.empty() || kind == found) continue;
    if (!found.empty()) return "";
    found = kind;
  }
  return found;
}

bool names_joint(const Words& words) {
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string stem = stem_of(words[k]);
    if (stands_in(stem, {"joint", "joints", "jnt"})) return true;
    // An axis and a j alone may be anything's: "axis x".
    const bool numbered =
        stem.size() < words[k].size() || (k + 1 < words.size() && is_number(words[k + 1]));
    if (is_joint_word(stem) && numbered) return true;
  }
  return false;
}

std::string lone_quantity(const Words& words) {
  std::string found;
  for (const std::string& word : words) {
    std::string kind = quantity_of(word);
    const bool current = is_current(word);  // else "current" is a word of state
    if (kind.empty() && current && &word == &words.back() && found.empty()) kind = "current:";
    if (kind.empty() && says_nothing(word)) continue;
    if (kind.empty() || !found.empty()) return "";
    found = kind;
  }
  return found;
}

std::string joint_role(const Words& words, const std::string& of_file) {
  std::string kind, name;
  bool current = false;
  const auto append = [&](const std::string& part) { name += (name.empty() ? "" : "_") + part; };
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string& word = words[k];
    const std::string stem = stem_of(word), quantity = quantity_of(stem);
    if (is_foreign(stem)) return "";
    // /joint_states/elbow_joint/position: a topic's words are no part of a name.
    const bool topic = k + 1 < words.size() && stands_in(word, {"joint", "joints"}) &&
                       stands_in(words[k + 1], {"state", "states"});
    if (topic) continue;
    current = current || is_current(stem);
    if (!quantity.empty()) {
      if (!kind.empty()) return "";
      kind = quantity;
      if (word.size() > stem.size()) append(word.substr(stem.size()));
    } else if (says_nothing(stem) || is_current(stem)) {
      if (word.size() > stem.size()) append(word.substr(stem.size()));
    } else {
      append(word);
    }
  }
  if (kind.empty() && current) kind = "current:";
  const bool marked = names_joint(words);
  if (kind.empty() && marked) kind = of_file;
  name = plain_joint(name);
  // A word of a joint alone is no name, and a number alone is one beside a quantity only.
  const bool named = marked ? !name.empty() && !is_joint_word(name) : is_number(name);
  return kind.empty() || !named ? "" : kind + name;
}

}  // namespace dcnn
