// SPDX-License-Identifier: Apache-2.0
#include "import/roles.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "import/frame_names.h"
#include "import/joint_names.h"
#include "import/units.h"

namespace dcnn {
namespace {

using Words = std::vector<std::string>;

bool is_one_of(const std::string& word, std::initializer_list<const char*> list) {
  return std::any_of(list.begin(), list.end(), [&](const char* other) { return word == other; });
}

bool has_word(const Words& words, std::initializer_list<const char*> list) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return is_one_of(word, list); });
}

/// 0, 1, 2 of x, y, z or of an index; -1 for another word.
int axis_of(const std::string& word) {
  constexpr std::array<const char*, 6> kAxes = {"x", "y", "z", "0", "1", "2"};
  const auto found = std::find(kAxes.begin(), kAxes.end(), word);
  return found == kAxes.end() ? -1 : static_cast<int>(found - kAxes.begin()) % 3;
}

std::string with_axis(const char* stem, int axis) { return stem + std::string(1, "xyz"[axis]); }

/// Names that are a column in one word.
std::string single_word(const std::string& word) {
  constexpr std::array kColumns = {"x",  "y",   "z",   "alpha", "beta", "gamma", "qw", "qx",
                                   "qy", "qz",  "fx",  "fy",    "fz",   "tx",    "ty", "tz",
                                   "vx", "vy",  "vz",  "wx",    "wy",   "wz",    "ax", "ay",
                                   "az", "dwx", "dwy", "dwz",   "rx",   "ry",    "rz"};
  if (std::find(kColumns.begin(), kColumns.end(), word) != kColumns.end()) return word;
  if (word.size() == 2 && word[0] == 'm' && axis_of(word.substr(1)) >= 0)
    return "t" + word.substr(1);
  if (word.size() == 2 && word[0] == 'p' && axis_of(word.substr(1)) >= 0) return word.substr(1);
  if (is_one_of(word, {"yaw"})) return "alpha";
  if (is_one_of(word, {"pitch"})) return "beta";
  if (is_one_of(word, {"roll"})) return "gamma";
  if (is_one_of(word, {"temperature", "temp"})) return "temperature";
  const bool matrix = word.size() == 3 && word[0] == 'r' && word[1] >= '1' && word[1] <= '3' &&
                      word[2] >= '1' && word[2] <= '3';
  return matrix ? word : "";
}

/// q1, dq1, qd1, tau1 and the like of an arm's joints.
std::string joint_word(const std::string& word) {
  const std::size_t digit = word.find_first_of("0123456789");
  if (digit == std::string::npos ||
      word.find_first_not_of("0123456789", digit) != std::string::npos) {
    return "";
  }
  const std::string stem = word.substr(0, digit), number = word.substr(digit);
  if (is_one_of(stem, {"q", "joint", "theta", "pos"})) return "q:" + number;
  if (is_one_of(stem, {"dq", "qd", "qdot", "vel"})) return "qd:" + number;
  if (is_one_of(stem, {"tau", "torque", "torques", "effort", "efforts"})) return "tau:" + number;
  return "";
}

/// The same of Position1 and velocity[1], where the stream has a torque of that number beside.
std::string joint_beside_torque(const LogStream& stream, const Words& words) {
  const std::string role = joint_role(words, "");
  const std::string number = role.substr(role.find(':') + 1);
  const bool torque =
      !role.empty() &&
      std::any_of(stream.channels.begin(), stream.channels.end(), [&](const LogChannel& channel) {
        std::string all;
        for (const std::string& word : words_of_name(channel.name)) all += word;
        return joint_word(all) == "tau:" + number;
      });
  return torque ? role : "";
}

/// The rotation of a 4x4 or 3x3 matrix whose elements are counted: libfranka's O_T_EE goes by
/// columns.
std::string matrix_element(const Words& words, int index) {
  if (!has_word(words, {"ee"}) || !has_word(words, {"t"})) return "";
  const int row = index % 4, column = index / 4;
  if (row > 2) return "";
  if (column == 3) return with_axis("", row);
  return "r" + std::to_string(row + 1) + std::to_string(column + 1);
}

/// Whose unit says what the axis in its name is of: "Sensor X (N)".
std::string by_unit(const std::string& name, const std::string& axis) {
  if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z') return "";
  const auto unit = find_unit(unit_of_name(name));
  if (!unit) return "";
  if (unit->quantity == "length") return axis;
  if (unit->quantity == "force") return "f" + axis;
  return unit->quantity == "torque" ? "t" + axis : "";
}

/// Quantity and component in several words: {wrench, force, x}, {actual, tcp, force, 3}.
std::string by_words(const LogStream& stream, const std::string& name, const Words& words) {
  const std::string& last = words.back();
  const bool number = !last.empty() && last.find_first_not_of("0123456789") == std::string::npos;
  const int index = number && last.size() < 3 ? std::stoi(last) : -1;
  const int axis = axis_of(last);
  if (is_no_measurement(words)) return "";
  if (has_word(words, {"tcp"}) && has_word(words, {"pose"}) && index >= 0 && index < 6) {
    return with_axis(index < 3 ? "" : "rv", index % 3);
  }
  if (has_word(words, {"tcp", "wrench"}) && has_word(words, {"force", "wrench"}) && index >= 0 &&
      index < 6) {
    return with_axis(index < 3 ? "f" : "t", index % 3);
  }
  const int elements = index >= 0 ? elements_beside(stream, name) : 0;
  if (elements == 6 && words.size() == 2 && index < 6) {  // of a UR's RTDE, as ur_rtde shortens it
    if (words[0] == "tcp") return with_axis(index < 3 ? "" : "rv", index % 3);
    if (words[0] == "tcpf") return with_axis(index < 3 ? "f" : "t", index % 3);
  }
  const bool external =
      has_word(words, {"ext"}) && has_word(words, {"f"});  // libfranka's F_ext_hat
  if (elements == 6 && (external || has_word(words, {"ft", "fts", "wrench"})) && index < 6) {
    return with_axis(index < 3 ? "f" : "t", index % 3);
  }
  if (index >= 0) {
    if (const std::string element = matrix_element(words, index); !element.empty()) return element;
  }
  const bool turn = has_word(words, {"orientation", "quaternion", "quat", "rotation", "q"});
  if (turn && (last == "w" || (axis >= 0 && !number))) return "q" + last;
  if (turn && index >= 0 && index < 4 && words.size() > 1 && !has_word(words, {"q"})) {
    return "quat" + std::to_string(index);
  }
  if (has_word(words, {"rpy", "euler"}) && axis >= 0) return "rot" + std::to_string(axis + 1);
  if (has_word(words, {"rot"}) && (last == "w" || axis >= 0) && !number) {
    const std::string w = name.substr(0, name.size() - 1);
    const bool four = stream.find(w + "w") >= 0 || stream.find(w + "W") >= 0;
    return (four ? "q" : "r") + last;
  }
  if (axis < 0 || elements > 3) return "";  // an array of more than three is no vector
  if (has_word(words, {"force", "forces", "f"})) return with_axis("f", axis);
  if (has_word(words, {"torque", "torques", "moment", "moments"})) return with_axis("t", axis);
  if (has_word(words, {"twist", "linear", "angular", "velocity", "acceleration"})) return "";
  if (has_word(words, {"position", "pos", "translation", "trans"})) return with_axis("", axis);
  return "";
}

/// sensor_msgs/JointState: position[elbow].
std::string joint_state(const std::string& channel) {
  const std::size_t open = channel.find('[');
  if (open == std::string::npos || channel.back() != ']') return "";
  const std::string field = channel.substr(0, open);
  const std::string joint = channel.substr(open + 1, channel.size() - open - 2);
  if (field == "position") return "q:" + joint;
  if (field == "velocity") return "qd:" + joint;
  return field == "effort" ? "tau:" + joint : "";
}

}  // namespace

bool is_no_measurement(const Words& words) {
  return has_word(words, {"covariance", "target", "desired", "des", "goal", "setpoint", "reference",
                          "ref", "cmd", "command", "commanded", "bias", "std", "raw_counts",
                          "gravity", "sim", "soll", "rsol", "aspos"});
}

Words words_of_name(const std::string& name) {
  const std::string text = name_without_unit(name);
  Words words;
  std::string word;
  const auto close = [&] {
    if (!word.empty()) words.push_back(std::exchange(word, ""));
  };
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto c = static_cast<unsigned char>(text[k]);
    if (std::isalnum(c) == 0) {
      close();
      continue;
    }
    const bool hump =
        k > 0 && std::isupper(c) != 0 && std::islower(static_cast<unsigned char>(text[k - 1])) != 0;
    if (hump) close();
    word += static_cast<char>(std::tolower(c));
  }
  close();
  return words;
}

std::string role_of(const LogStream& stream, const std::string& full_name) {
  // "Fx#2" is the second column called Fx (text_layout.cpp), and as good as the first.
  const std::size_t mark = full_name.rfind('#');
  const bool copy = mark != std::string::npos && mark > 0 && mark + 1 < full_name.size() &&
                    full_name.find_first_not_of("0123456789", mark + 1) == std::string::npos;
  const std::string channel = copy ? full_name.substr(0, mark) : full_name;
  if (stream.type.ends_with("JointState")) return joint_state(channel);
  if (stream.type.ends_with("/Imu") || stream.type.find("Twist") != std::string::npos) return "";
  const bool unknown_unit = !unknown_unit_of_name(channel).empty();
  const Words words =
      words_of_name(unknown_unit ? channel.substr(0, channel.find_last_of("[(")) : channel);
  if (words.empty()) return "";
  if (words.size() == 2 && words[1] == "sim" && words[0].size() == 2) {
    return single_word(words[0]).empty() ? "" : single_word(words[0]) + "_sim";
  }
  if (words.size() == 1) {
    if (const std::string role = by_unit(channel, words[0]); !role.empty()) return role;
    const std::string column = single_word(words[0]);
    if (!column.empty()) return column;
    if (const std::string role = matrix_word(stream, channel); !role.empty()) return role;
    if (const std::string role = kuka_word(stream, words); !role.empty()) return role;
    const std::string of_file = joint_quantity_of_file(words_of_name(stream.source));
    const std::string role = of_file.empty() ? "" : joint_role(words, of_file);
    if (!role.empty()) return role;
    const std::string word = joint_word(words[0]);
    return word.empty() ? joint_beside_torque(stream, words) : word;
  }
  const std::string of_file = joint_quantity_of_file(words_of_name(stream.source));
  const bool joint = names_joint(words) && !is_no_measurement(words);
  if (const std::string role = joint ? joint_role(words, of_file) : ""; !role.empty()) return role;
  if (const std::string role = by_words(stream, channel, words); !role.empty()) {
    return joint && role.size() == 1 ? "" : role;  // no position of a tool
  }
  const bool indexed =
      words.size() == 2 && words[1].find_first_not_of("0123456789") == std::string::npos;
  if (indexed) {  // tau[3]
    const std::string word = joint_word(words[0] + words[1]);
    return word.empty() ? joint_beside_torque(stream, words) : word;
  }
  if (is_no_measurement(words)) return "";
  if (const std::string role = kuka_word(stream, words); !role.empty()) return role;
  if (const std::string role = joint_role(words, ""); !role.empty()) return role;
  // "sensor.fx", "/ft/Fx", "tool_roll": the last word alone, where it is one of a vector's names.
  if (words.back().size() == 1) return by_unit(channel, words.back());
  const std::string last = single_word(words.back());
  // What an IMU measures holds gravity, in its own frame.
  if (last.size() == 2 && last[0] == 'a' && has_word(words, {"imu"})) return "";
  return last.empty() ? matrix_word(stream, channel) : last;
}

int clock_rank(const std::string& channel) {
  Words words = words_of_name(channel);
  if (words.empty()) return 0;
  if (has_word(words, {"header"}) && words.back() == "stamp") return 3;
  // "data.timeStamp": what it is called in the structure that holds it.
  const Words own = words_of_name(channel.substr(channel.find_last_of('.') + 1));
  if (own.empty()) return 0;
  words = own;
  if (words.size() <= 2 &&
      is_one_of(words.back(), {"time", "times", "timestamp", "timestamps", "stamp", "clock", "tout",
                               "datetime", "duration"})) {
    return 2;
  }
  if (words.size() == 1 && is_one_of(words[0], {"zeit", "datum", "date", "ipoc"})) return 2;
  if (words.size() == 2 && words[0] == "time") return 2;  // time_ms
  if (words.size() == 2 && words[0] == "t" && words[1].size() > 1 && axis_of(words[1]) < 0)
    return 1;
  return own.size() == 1 && own[0] == "t" ? 1 : 0;
}

int stamp_part(const std::string& channel) {
  const std::size_t at = channel.find_last_of("._/ ");
  std::string tail = at == std::string::npos ? channel : channel.substr(at + 1);
  std::transform(tail.begin(), tail.end(), tail.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (is_one_of(tail, {"secs", "sec", "seconds"})) return 1;
  return is_one_of(tail, {"nsecs", "nsec", "nanosec", "nanoseconds", "nanosecs"}) ? 2 : 0;
}

}  // namespace dcnn
