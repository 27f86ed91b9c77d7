#include <algorithm>
#include <set>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "dcnn/core/options.h"
#include "import/candidates.h"
#include "import/clocks.h"
#include "import/column_units.h"
#include "import/joint_columns.h"
#include "import/roles.h"

namespace dcnn {
namespace {

using Names = std::vector<std::string>;

/// Columns that stand or fall together, in the order in which they are looked for.
struct VectorRole {
  const char* words;
  Names columns;
};

const std::vector<VectorRole>& vector_roles() {
  static const std::vector<VectorRole> kRoles = {
      {"force", {"fx", "fy", "fz"}},
      {"torque", {"tx", "ty", "tz"}},
      {"position", {"x", "y", "z"}},
      {"quaternion", {"qw", "qx", "qy", "qz"}},
      {"quaternion by index", {"quat0", "quat1", "quat2", "quat3"}},
      {"rotation matrix", {"r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"}},
      {"angles", {"alpha", "beta", "gamma"}},
      {"angles by index", {"rot1", "rot2", "rot3"}},
      {"rotation vector", {"rvx", "rvy", "rvz"}},
      {"velocity", {"vx", "vy", "vz"}},
      {"angular velocity", {"wx", "wy", "wz"}},
      {"acceleration", {"ax", "ay", "az"}},
      {"angular acceleration", {"dwx", "dwy", "dwz"}},
      {"simulated force", {"fx_sim", "fy_sim", "fz_sim"}},
      {"simulated torque", {"tx_sim", "ty_sim", "tz_sim"}},
      {"temperature", {"temperature"}}};
  return kRoles;
}

class Proposer {
 public:
  Proposer(const ForeignLog& log, const ImportWishes& wishes) : log_(log), wishes_(wishes) {}

  Proposal run() {
    take_mapped();
    for (const VectorRole& role : vector_roles()) take_vector(role);
    take_joints();
    for (const std::string& name : wishes_.also) take_also(name);
    set_orientation();
    recipe().wrench = wishes_.wrench;
    recipe().arm = wishes_.arm;
    note_frames();
    set_clocks();
    propose_units(log_, wishes_, &proposal_);
    return std::move(proposal_);
  }

 private:
  Recipe& recipe() { return proposal_.recipe; }

  bool has(const std::string& to) {
    return std::any_of(recipe().columns.begin(), recipe().columns.end(),
                       [&](const ColumnRule& rule) { return rule.to == to; });
  }
  bool has_any(const Names& columns) {
    return std::any_of(columns.begin(), columns.end(), [&](const auto& to) { return has(to); });
  }

  /// "STREAM:CHANNEL", or a channel's name that one stream alone has.
  ColumnRule find_channel(const std::string& spec) const {
    Names streams, all;
    for (const LogStream& stream : log_.streams) {
      for (const LogChannel& channel : stream.channels) {
        if (spec == stream.name + ":" + channel.name) {
          return {.to = "", .stream = stream.name, .channel = channel.name};
        }
        if (spec == channel.name) streams.push_back(stream.name);
        all.push_back(channel.name);
      }
    }
    const std::string near = nearest_word(spec, all);
    require(!streams.empty(), Exit::kUsage, log_.file, ": there is no channel ", shown(spec),
            near.empty() ? "; see --dry-run" : "; did you mean " + shown(near) + "?");
    require(streams.size() == 1, Exit::kUsage, log_.file, ": ", streams.size(),
            " streams have a channel ", shown(spec), "; name one: ", streams[0], ":", spec);
    return {.to = "", .stream = streams[0], .channel = spec};
  }

  void take(const std::string& to, ColumnRule rule) {
    rule.to = to;
    recipe().columns.push_back(std::move(rule));
  }

  void take_mapped() {
    for (const auto& [to, spec] : wishes_.map) take(to, find_channel(spec));
  }

  void take_also(const std::string& spec) {
    const ColumnRule rule = find_channel(spec);
    std::string to;
    for (const std::string& word : words_of_name(rule.channel))
      to += (to.empty() ? "" : "_") + word;
    take(to, rule);
  }

  bool may_use(const LogStream& stream) const {
    return wishes_.use.empty() ||
           std::find(wishes_.use.begin(), wishes_.use.end(), stream.name) != wishes_.use.end();
  }

  /// The channels of a stream that are the columns of a vector, but for those that were said; empty
  /// where one is missing.
  std::vector<ColumnRule> find_vector(const LogStream& stream, const VectorRole& role,
                                      bool as_translation) {
    std::vector<ColumnRule> rules;
    std::string open;
    for (const std::string& column : role.columns) {
      if (has(column)) continue;
      if (auto rule = in_said_array(stream, role.columns, column, recipe().columns)) {
        rules.push_back(std::move(*rule));
        continue;
      }
      Names candidates;
      for (const LogChannel& channel : stream.channels) {
        std::string found = role_of(stream, channel.name);
        if (as_translation && found.size() == 2 && found[0] == 't') found.erase(0, 1);
        if (found == column && channel.finite > 0) candidates.push_back(channel.name);
      }
      if (candidates.empty()) return {};
      const auto nearest = nearest_to_said(candidates, said_of(stream));
      if (candidates.size() > 1 && !nearest && open.empty()) {
        open = question_between(column, stream.name, candidates);
      }
      rules.push_back(
          {.to = column, .stream = stream.name, .channel = candidates[nearest.value_or(0)]});
    }
    if (!open.empty()) proposal_.questions.push_back(open);
    return rules;
  }

  /// Channels of a stream that --map names.
  Names said_of(const LogStream& stream) const {
    Names said;
    for (const auto& [to, spec] : wishes_.map) {
      const ColumnRule rule = find_channel(spec);
      if (rule.stream == stream.name) said.push_back(rule.channel);
    }
    return said;
  }

  void take_vector(const VectorRole& role) {
    const bool oriented = has_any({"qw", "quat0", "r11", "alpha", "rot1"});
    const std::string first = role.columns[0];
    if (std::all_of(role.columns.begin(), role.columns.end(),
                    [&](const std::string& column) { return has(column); })) {
      return;
    }
    if (oriented && !has(first) &&
        (first == "quat0" || first == "r11" || first == "alpha" || first == "rot1" ||
         first == "rvx")) {
      return;
    }
    std::string said;  // the stream of what --map says of this vector
    for (const ColumnRule& rule : recipe().columns) {
      const bool part =
          std::find(role.columns.begin(), role.columns.end(), rule.to) != role.columns.end();
      if (part && said.empty()) said = rule.stream;
    }
    std::vector<std::vector<ColumnRule>> found;
    for (const LogStream& stream : log_.streams) {
      if (!may_use(stream) || (!said.empty() && stream.name != said)) continue;
      const bool trajectory = is_trajectory(stream);
      if (trajectory && first == "tx") continue;
      auto rules = find_vector(stream, role, trajectory && first == "x");
      if (rules.empty()) continue;
      if (trajectory && first == "x") {
        proposal_.notes.push_back("tx, ty, tz without a force beside them are a translation");
      }
      found.push_back(std::move(rules));
    }
    prefer_sister(role, &found);
    if (found.size() > 1) ask_stream(role, found);
    if (found.size() != 1) return;
    for (ColumnRule& rule : found[0]) take(rule.to, rule);
  }

  /// A torque is that of the force, an orientation that of the position.
  void prefer_sister(const VectorRole& role, std::vector<std::vector<ColumnRule>>* found) {
    const bool wrench = role.columns[0] == "tx";
    for (const ColumnRule& taken : recipe().columns) {
      if (taken.to != (wrench ? "fx" : "x")) continue;
      for (const auto& rules : *found) {
        if (rules[0].stream != taken.stream) continue;
        const std::vector<ColumnRule> sister = rules;
        *found = {sister};
        return;
      }
    }
  }

  void ask_stream(const VectorRole& role, const std::vector<std::vector<ColumnRule>>& found) {
    std::string words = std::string("several streams have a ") + role.words + ": say --use ";
    for (const auto& rules : found) words += (&rules == &found[0] ? "" : " or ") + rules[0].stream;
    proposal_.questions.push_back(words);
  }

  /// Joint angles, rates and torques: of an arm, or for a pose by --urdf.
  void take_joints() {
    if (has("fx") && has_any({"qw", "quat0", "r11", "alpha", "rot1", "rvx"})) return;
    for (const ColumnRule& rule : find_joints(log_, recipe().columns, wishes_.use, &proposal_)) {
      take(rule.to, rule);
    }
  }

  void set_orientation() {
    OrientationRule& rule = recipe().orientation = wishes_.orientation;
    if (has("quat0")) {
      rename_quaternion();
    } else if (has("rot1") || (has("alpha") && !wishes_.euler_order.empty())) {
      rule.kind = "euler";
      rule.order = wishes_.euler_order;
      if (rule.order.empty()) {
        proposal_.questions.push_back(
            "in which order do the three angles turn? say --euler-order xyz (roll, pitch, yaw "
            "about fixed axes) or ZYX (about moving axes)");
      }
    }
    if (has("qw")) rule.kind = "quaternion";
    if (has("alpha") && rule.kind.empty()) rule.kind = "euler";
    if (has("r11")) rule.kind = "matrix";
    if (has("rvx")) rule.kind = "rotation-vector";
    if (rule.kind.empty() && !wishes_.arm.urdf.empty()) rule.kind = "joints";
  }

  void rename_quaternion() {
    const std::string& order = wishes_.quaternion_order;
    if (order.empty()) {
      proposal_.questions.push_back(
          "which element of the quaternion is w? say --quaternion-order xyzw or wxyz");
      return;
    }
    for (ColumnRule& rule : recipe().columns) {
      if (!rule.to.starts_with("quat")) continue;
      rule.to = std::string("q") + order[static_cast<std::size_t>(rule.to[4] - '0')];
    }
  }

  /// What the makers of robots say of a name that says nothing itself.
  void note_frames() {
    for (const ColumnRule& rule : recipe().columns) {
      if (rule.to != "fx" || rule.channel.find("TCP_force") == std::string::npos) continue;
      if (wishes_.wrench.frame == "base") continue;
      proposal_.notes.push_back(shown(rule.channel) +
                                " of a UR is in the base frame: say --wrench-frame base");
    }
  }

  void set_clocks() {
    std::set<std::string> used;
    for (const ColumnRule& rule : recipe().columns) used.insert(rule.stream);
    for (const LogStream& stream : log_.streams) {
      if (!used.contains(stream.name)) continue;
      recipe().clocks.push_back(propose_clock(stream, wishes_, &proposal_.guesses));
    }
    if (const auto alone = lone_clock(log_, recipe().clocks, wishes_, &proposal_.guesses)) {
      recipe().clocks.push_back(*alone);
    } else {
      for (ClockRule& clock : recipe().clocks) {
        for (const LogStream& stream : log_.streams) {
          if (stream.name == clock.stream) propose_unnamed(stream, &clock, &proposal_.guesses);
        }
      }
    }
    for (const char* first : {"fx", "tx", "x", "qw"}) {
      for (const ColumnRule& rule : recipe().columns) {
        if (recipe().clock.empty() && rule.to == first) recipe().clock = rule.stream;
      }
    }
    if (recipe().clock.empty() && !recipe().columns.empty()) {
      recipe().clock = recipe().columns[0].stream;
    }
  }

  const ForeignLog& log_;
  const ImportWishes& wishes_;
  Proposal proposal_;
};

}  // namespace

Proposal propose(const ForeignLog& log, const ImportWishes& wishes) {
  return Proposer(log, wishes).run();
}

}  // namespace dcnn
