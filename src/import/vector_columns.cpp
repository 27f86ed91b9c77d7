// SPDX-License-Identifier: Apache-2.0
#include "import/vector_columns.h"

#include <algorithm>
#include <cmath>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "dcnn/core/options.h"
#include "dcnn/import/summary.h"
#include "import/candidates.h"
#include "import/roles.h"

namespace dcnn {
namespace {

using Names = std::vector<std::string>;

/// Columns that stand or fall together, in the order in which they are looked for.
struct VectorRole {
  const char* words;
  Names columns;
  bool turns = false;  ///< one of several kinds of orientation
};

const std::vector<VectorRole>& vector_roles() {
  static const std::vector<VectorRole> kRoles = {
      {"force", {"fx", "fy", "fz"}},
      {"torque", {"tx", "ty", "tz"}},
      {"position", {"x", "y", "z"}},
      {"quaternion", {"qw", "qx", "qy", "qz"}, true},
      {"quaternion by index", {"quat0", "quat1", "quat2", "quat3"}, true},
      {"rotation matrix", {"r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"}, true},
      {"angles", {"alpha", "beta", "gamma"}, true},
      {"angles by index", {"rot1", "rot2", "rot3"}, true},
      {"rotation vector", {"rvx", "rvy", "rvz"}, true},
      {"rotation", {"rx", "ry", "rz"}, true},
      {"velocity", {"vx", "vy", "vz"}},
      {"angular velocity", {"wx", "wy", "wz"}},
      {"acceleration", {"ax", "ay", "az"}},
      {"angular acceleration", {"dwx", "dwy", "dwz"}},
      {"simulated force", {"fx_sim", "fy_sim", "fz_sim"}},
      {"simulated torque", {"tx_sim", "ty_sim", "tz_sim"}},
      {"temperature", {"temperature"}}};
  return kRoles;
}

/// What one stream gives to a role.
struct Found {
  std::vector<ColumnRule> rules;
  std::string question;  ///< where several channels may be one column
};

class VectorFinder {
 public:
  VectorFinder(const ForeignLog& log, const ImportWishes& wishes, Proposal* proposal)
      : log_(log), wishes_(wishes), proposal_(*proposal) {}

  void take(const VectorRole& role) {
    const std::string first = role.columns[0];
    if (std::all_of(role.columns.begin(), role.columns.end(),
                    [&](const std::string& column) { return has(column); })) {
      return;
    }
    if (role.turns && oriented() && !has_any(role.columns)) return;
    std::vector<Found> found;
    for (const LogStream& stream : log_.streams) {
      if (const std::string said = said_stream(role); !said.empty() && stream.name != said)
        continue;
      const bool trajectory = is_trajectory(stream);
      if (trajectory && first == "tx") continue;
      Found here = find_in(stream, role, trajectory && first == "x");
      if (here.rules.empty()) continue;
      if (trajectory && first == "x") {
        proposal_.notes.push_back("tx, ty, tz without a force beside them are a translation");
      }
      found.push_back(std::move(here));
    }
    prefer(&found, [&](const ColumnRule& rule) { return is_used(rule.stream); });
    // A torque is that of the force, an orientation that of the position.
    const std::string sister = stream_of(first == "tx" ? "fx" : "x");
    prefer(&found, [&](const ColumnRule& rule) { return rule.stream == sister; });
    if (found.size() > 1) ask_stream(role, found);
    if (found.size() == 1) take_found(found[0]);
    if (found.empty()) say_what_is_missing(role);
  }

 private:
  bool has(const std::string& to) const { return !stream_of(to).empty(); }
  bool has_any(const Names& columns) const {
    return std::any_of(columns.begin(), columns.end(), [&](const auto& to) { return has(to); });
  }
  bool oriented() const {
    const auto turns = [&](const VectorRole& role) { return role.turns && has_any(role.columns); };
    return std::any_of(vector_roles().begin(), vector_roles().end(), turns);
  }

  /// Of the column, empty where it is not there.
  std::string stream_of(const std::string& to) const {
    for (const ColumnRule& rule : proposal_.recipe.columns) {
      if (rule.to == to) return rule.stream;
    }
    return "";
  }
  /// The stream of what --map says of this vector.
  std::string said_stream(const VectorRole& role) const {
    for (const std::string& column : role.columns) {
      if (has(column)) return stream_of(column);
    }
    return "";
  }
  bool is_used(const std::string& stream) const {
    return std::find(wishes_.use.begin(), wishes_.use.end(), stream) != wishes_.use.end();
  }

  /// Leaves those alone that are as wanted, where there are such.
  template <class Wanted>
  static void prefer(std::vector<Found>* found, const Wanted& wanted) {
    const auto is = [&](const Found& one) { return wanted(one.rules[0]); };
    if (!std::any_of(found->begin(), found->end(), is)) return;
    std::erase_if(*found, [&](const Found& one) { return !is(one); });
  }

  /// The channels of a stream that are the columns of a vector, but for those that were said; none
  /// where one is missing.
  Found find_in(const LogStream& stream, const VectorRole& role, bool as_translation) const {
    Found found;
    for (const std::string& column : role.columns) {
      if (has(column)) continue;
      if (auto rule = in_said_array(stream, role.columns, column, proposal_.recipe.columns)) {
        found.rules.push_back(std::move(*rule));
        continue;
      }
      Names candidates;
      for (const LogChannel& channel : stream.channels) {
        std::string known = role_of(stream, channel.name);
        if (as_translation && known.size() == 2 && known[0] == 't') known.erase(0, 1);
        if (known == column && channel.finite > 0) candidates.push_back(channel.name);
      }
      if (candidates.empty()) return {};
      const auto nearest = nearest_to_said(candidates, said_of(stream));
      if (candidates.size() > 1 && !nearest && found.question.empty()) {
        found.question = question_between(column, stream.name, candidates);
      }
      found.rules.push_back(
          {.to = column, .stream = stream.name, .channel = candidates[nearest.value_or(0)]});
    }
    return found;
  }

  /// Channels of a stream that --map names.
  Names said_of(const LogStream& stream) const {
    Names said;
    for (const auto& [to, spec] : wishes_.map) {
      const ColumnRule rule = find_channel(log_, spec);
      if (rule.stream == stream.name) said.push_back(rule.channel);
    }
    return said;
  }

  void take_found(const Found& found) {
    if (!found.question.empty()) proposal_.questions.push_back(found.question);
    proposal_.recipe.columns.insert(proposal_.recipe.columns.end(), found.rules.begin(),
                                    found.rules.end());
  }

  /// Of a vector of which a part was said.
  void say_what_is_missing(const VectorRole& role) {
    if (!has_any(role.columns)) return;
    std::string words;
    for (const std::string& column : role.columns) {
      if (!has(column)) words += " --map " + column + "=CHANNEL";
    }
    proposal_.notes.push_back(std::string("of the ") + role.words + " not all is there: say" +
                              words);
  }

  void ask_stream(const VectorRole& role, const std::vector<Found>& found) {
    std::string words = std::string("several streams have a ") + role.words + ": say --use ";
    for (const Found& one : found) {
      words += (&one == &found[0] ? "" : " or ") + quoted_argument(one.rules[0].stream);
    }
    proposal_.questions.push_back(words);
  }

  const ForeignLog& log_;
  const ImportWishes& wishes_;
  Proposal& proposal_;
};

bool are_of_unit_length(const LogStream& stream, const Names& names) {
  constexpr double kOff = 2e-3;  // of a length in four digits
  Index whole = 0;
  for (std::size_t row = 0; row < static_cast<std::size_t>(stream.rows); ++row) {
    double square = 0.0;
    for (const std::string& name : names) {
      const auto& values = stream.channels[static_cast<std::size_t>(stream.find(name))].values;
      if (values.size() <= row) return false;
      square += values[row] * values[row];
    }
    if (std::isnan(square)) continue;
    if (std::abs(std::sqrt(square) - 1.0) > kOff) return false;
    ++whole;
  }
  return whole > 0;
}

}  // namespace

ColumnRule find_channel(const ForeignLog& log, const std::string& spec) {
  Names streams, all;
  for (const LogStream& stream : log.streams) {
    for (const LogChannel& channel : stream.channels) {
      if (spec == stream.name + ":" + channel.name) {
        return {.to = "", .stream = stream.name, .channel = channel.name};
      }
      if (spec == channel.name) streams.push_back(stream.name);
      all.push_back(channel.name);
    }
  }
  const std::string near = nearest_word(spec, all);
  require(!streams.empty(), Exit::kUsage, log.file, ": there is no channel ", shown(spec),
          near.empty() ? "; see --dry-run" : "; did you mean " + shown(near) + "?");
  require(streams.size() == 1, Exit::kUsage, log.file, ": ", streams.size(),
          " streams have a channel ", shown(spec), "; name one: ", streams[0], ":", spec);
  return {.to = "", .stream = streams[0], .channel = spec};
}

void find_vectors(const ForeignLog& log, const ImportWishes& wishes, Proposal* proposal) {
  VectorFinder finder(log, wishes, proposal);
  for (const VectorRole& role : vector_roles()) finder.take(role);
}

void leave_pose_of_arm(const ImportWishes& wishes, Proposal* proposal) {
  std::vector<ColumnRule>& columns = proposal->recipe.columns;
  const auto has = [&](const char* kind) {
    return std::any_of(columns.begin(), columns.end(),
                       [&](const ColumnRule& rule) { return rule.to.starts_with(kind); });
  };
  if (!has("q:") || !has("tau:") || has("fx") || has("tx")) return;
  const auto of_pose = [](const VectorRole& role, const std::string& to) {
    const bool holds =
        std::find(role.columns.begin(), role.columns.end(), to) != role.columns.end();
    return holds && (role.turns || role.columns[0] == "x");
  };
  const auto left = std::erase_if(columns, [&](const ColumnRule& rule) {
    return !wishes.map.contains(rule.to) &&
           std::any_of(vector_roles().begin(), vector_roles().end(),
                       [&](const VectorRole& role) { return of_pose(role, rule.to); });
  });
  if (left == 0) return;
  proposal->notes.push_back(
      "a pose is there, too: left out, for joints with torques need none; where a force belongs to "
      "it say --map fx=CHANNEL");
}

std::vector<ColumnRule> find_unit_quaternion(const ForeignLog& log) {
  std::vector<ColumnRule> found;
  for (const LogStream& stream : log.streams) {
    for (const LogChannel& channel : stream.channels) {
      const auto first = counted(channel.name);
      if (!first || first->number > 1) continue;
      const auto name = [&](int k) {
        return first->before + std::to_string(first->number + k) + first->after;
      };
      const Names names = {name(0), name(1), name(2), name(3)};
      const auto there = [&](const std::string& one) { return stream.find(one) >= 0; };
      if (!std::all_of(names.begin(), names.end(), there) || there(name(-1)) || there(name(4))) {
        continue;
      }
      if (channel.high - channel.low <= 0.0 || !are_of_unit_length(stream, names)) continue;
      if (!found.empty()) return {};
      for (int k = 0; k < 4; ++k) {
        found.push_back(
            {.to = "quat" + std::to_string(k), .stream = stream.name, .channel = name(k)});
      }
    }
  }
  return found;
}

}  // namespace dcnn
