// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "import/clocks.h"
#include "import/column_units.h"
#include "import/joint_columns.h"
#include "import/roles.h"
#include "import/said_streams.h"
#include "import/vector_columns.h"

namespace dcnn {
namespace {

using Names = std::vector<std::string>;

class Proposer {
 public:
  Proposer(const ForeignLog& log, const ImportWishes& wishes) : log_(log), wishes_(wishes) {}

  Proposal run() {
    take_mapped();
    demand_clocks();
    if (!of_arm()) find_vectors(log_, wishes_, &proposal_);
    take_quaternion();
    take_joints();
    leave_pose_of_arm(wishes_, &proposal_);
    for (const std::string& name : wishes_.also) take_also(name);
    set_orientation();
    recipe().wrench = wishes_.wrench;
    recipe().arm = wishes_.arm;
    choose_wrench_frame();
    note_what_is_missing();
    set_clocks();
    say_units_first();
    ask_for_clock(log_, &proposal_);
    ask_for_stamps(log_, wishes_, &proposal_);
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

  void take(const std::string& to, ColumnRule rule) {
    rule.to = to;
    recipe().columns.push_back(std::move(rule));
  }

  void take_mapped() {
    for (const auto& [to, spec] : wishes_.map) take(to, find_channel(log_, spec));
  }

  void take_also(const std::string& spec) {
    const ColumnRule rule = find_channel(log_, spec);
    std::string to;
    for (const std::string& word : words_of_name(rule.channel))
      to += (to.empty() ? "" : "_") + word;
    take(to, rule);
  }

  /// The streams of --use have joints and nothing else.
  bool uses_joints_alone() const {
    bool joints = false;
    for (const LogStream& stream : log_.streams) {
      if (std::find(wishes_.use.begin(), wishes_.use.end(), stream.name) == wishes_.use.end()) {
        continue;
      }
      for (const LogChannel& channel : stream.channels) {
        const std::string role = role_of(stream, channel.name);
        if (!role.empty() && role.find(':') == std::string::npos) return false;
        joints = joints || !role.empty();
      }
    }
    return joints;
  }

  /// Joints are said, and no part of a wrench or pose: a recording of the arm alone.
  bool of_arm() const {
    if (uses_joints_alone() && wishes_.map.empty()) return wishes_.arm.urdf.empty();
    bool joints = false;
    for (const auto& [to, spec] : wishes_.map) {
      if (to.find(':') == std::string::npos) return false;
      joints = true;
    }
    return joints && wishes_.arm.urdf.empty();
  }

  /// A --clock that no stream has as numbers.
  void demand_clocks() const {
    for (const std::string& said : wishes_.clock) {
      const auto has_it = [&](const LogStream& stream) {
        return stream.find(said) >= 0 || said.starts_with(stream.name + ":");
      };
      if (std::any_of(log_.streams.begin(), log_.streams.end(), has_it)) continue;
      const bool text = std::any_of(log_.notes.begin(), log_.notes.end(), [&](const auto& note) {
        return note.find(shown(said) + " holds text") != std::string::npos;
      });
      fail(text ? Exit::kData : Exit::kUsage, log_.file, ": --clock ", said,
           text ? " holds text that is neither a number, a date nor a time of day; say --rate"
                : ": there is no channel of this name; see --dry-run");
    }
  }

  /// Four channels of unit length beside a wrench: q0 to q3 are a joint's without one.
  void take_quaternion() {
    if (!has("fx") || has_any({"qw", "quat0", "r11", "alpha", "rot1", "rvx", "rx"})) return;
    for (const ColumnRule& rule : find_unit_quaternion(log_)) take(rule.to, rule);
  }

  /// Joint angles, rates and torques: of an arm, or for a pose by --urdf.
  void take_joints() {
    const bool posed = has_any({"qw", "quat0", "r11", "alpha", "rot1", "rvx", "rx"});
    if (has("fx") && posed && !of_arm()) return note_joints();
    for (const ColumnRule& rule : find_joints(log_, recipe().columns, wishes_.use, &proposal_)) {
      take(rule.to, rule);
    }
  }

  /// What else is in a log from which a wrench and a pose are taken.
  void note_joints() {
    Proposal other;
    const auto joints = find_joints(log_, {}, {}, &other);
    const auto first = [&](const char* kind) {
      const auto found = std::find_if(joints.begin(), joints.end(), [&](const ColumnRule& rule) {
        return rule.to.starts_with(kind);
      });
      return found == joints.end() ? "" : " --map " + found->to + "=" + found->channel;
    };
    if (const std::string q = first("q:"), tau = first("tau:"); !q.empty() && !tau.empty()) {
      proposal_.notes.push_back("joints are there, too; for a recording of the arm instead say" +
                                q + tau + " (those counted on from them follow)");
    }
  }

  /// A recording without a force says nothing of what acts.
  void note_what_is_missing() {
    const auto is_effort = [](const ColumnRule& rule) {
      return rule.to == "fx" || rule.to == "tx" || rule.to.starts_with("tau:") ||
             rule.to.starts_with("q:");
    };
    const auto& columns = recipe().columns;
    if (columns.empty() || std::any_of(columns.begin(), columns.end(), is_effort)) return;
    proposal_.notes.push_back(
        "no force is known by its name (fx, fy and fz, all three): the recording has a motion "
        "alone; "
        "say --map fx=CHANNEL (fy and fz follow where they are called alike)");
  }

  /// rx, ry, rz: what they are must be said.
  void name_rotation() {
    if (!has("rx")) return;
    if (wishes_.euler_order.empty()) {
      const auto first = std::find_if(recipe().columns.begin(), recipe().columns.end(),
                                      [](const ColumnRule& rule) { return rule.to == "rx"; });
      proposal_.questions.push_back(
          shown(first->channel) +
          " and its neighbours may be three angles or a rotation vector: say --euler-order xyz "
          "(roll, pitch, yaw about fixed axes; ZYX and others about moving ones) or --map rvx=" +
          first->channel + " (rotation vector, as of UR)");
      return;
    }
    for (ColumnRule& rule : recipe().columns) {
      if (rule.to == "rx") rule.to = "rot1";
      if (rule.to == "ry") rule.to = "rot2";
      if (rule.to == "rz") rule.to = "rot3";
    }
  }

  void set_orientation() {
    name_rotation();
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

  /// What the makers of robots say of a name that says nothing itself: a UR's actual_TCP_force is
  /// in the base frame, less the payload that was entered (RTDE guide), and so is libfranka's
  /// O_F_ext_hat_K; K_F_ext_hat_K is in the stiffness frame, which turns with the end effector.
  void choose_wrench_frame() {
    std::string& frame = recipe().wrench.frame;
    const bool open = frame == "auto";
    if (open) frame = "sensor";
    for (const ColumnRule& rule : recipe().columns) {
      const auto has = [&](const char* name) {
        return rule.channel.find(name) != std::string::npos;
      };
      const bool ur = has("TCP_force") || has("tcpf_"), franka = has("F_ext_hat"),
                 in_base = ur || has("O_F_ext");
      if (rule.to != "fx" || (!ur && !franka)) continue;
      const bool oriented = !recipe().orientation.kind.empty();
      std::string words = shown(rule.channel) + (ur ? " of a UR" : " of a Franka") + " is in the " +
                          (in_base ? "base frame" : "stiffness frame, taken for the sensor's");
      if (in_base && open && oriented) {
        frame = "base";
        words += ": it is turned into the sensor's by the pose";
      } else if (in_base && frame != "base") {
        words += oriented ? ": say --wrench-frame base"
                          : ", and the log has no pose to turn it by: log one, or give --urdf "
                            "ROBOT and --link LINK";
      }
      proposal_.notes.push_back(words +
                                "; the controller has subtracted the payload from it, which "
                                "--payload adds back");
    }
  }

  /// What is to be said of units stands before what is to be said of clocks and rates.
  void say_units_first() {
    std::vector<std::string>& guesses = proposal_.guesses;
    const auto of_clocks = std::ssize(guesses);
    propose_units(log_, wishes_, &proposal_);
    std::rotate(guesses.begin(), guesses.begin() + of_clocks, guesses.end());
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
  const ImportWishes resolved = resolved_wishes(log, wishes);
  return Proposer(log, resolved).run();
}

}  // namespace dcnn
