// SPDX-License-Identifier: Apache-2.0
#include "import/joint_columns.h"

#include <algorithm>
#include <map>
#include <set>

#include "data/text.h"
#include "import/candidates.h"
#include "import/joint_names.h"
#include "import/roles.h"

namespace dcnn {
namespace {

using Names = std::vector<std::string>;

bool is_joint(const std::string& to) {
  return to.starts_with("q:") || to.starts_with("qd:") || to.starts_with("tau:");
}

/// The joint of a column: "elbow" of q:elbow.
std::string joint_of(const std::string& to) { return to.substr(to.find(':') + 1); }

class JointFinder {
 public:
  JointFinder(const ForeignLog& log, const std::vector<ColumnRule>& taken, const Names& use,
              Proposal* proposal)
      : log_(log), said_(taken), use_(use), proposal_(proposal) {}

  std::vector<ColumnRule> run() {
    for (const ColumnRule& rule : said_) {
      if (is_joint(rule.to)) count_on(rule);
    }
    learn_names();
    by_name();
    if (found_.empty()) by_pairs();
    take_currents();
    leave_lone();
    if (found_.empty() && said_.empty()) only_joint();
    ask();
    return found_;
  }

 private:
  bool has(const std::string& to) const {
    const auto is = [&](const ColumnRule& rule) { return rule.to == to; };
    return std::any_of(said_.begin(), said_.end(), is) ||
           std::any_of(found_.begin(), found_.end(), is);
  }

  bool is_used(const std::string& stream, const std::string& channel) const {
    const auto is = [&](const ColumnRule& rule) {
      return rule.stream == stream && rule.channel == channel;
    };
    return std::any_of(said_.begin(), said_.end(), is) ||
           std::any_of(found_.begin(), found_.end(), is);
  }

  /// The channels that differ from a said one by their number alone, where that one is the first
  /// of them and none of the others was said.
  void count_on(const ColumnRule& said) {
    const auto column = counted(said.to), channel = counted(said.channel);
    if (!column || !channel) return;
    std::map<int, std::string> others;
    for (const LogStream& stream : log_.streams) {
      if (stream.name != said.stream) continue;
      for (const LogChannel& other : stream.channels) {
        const auto name = counted(other.name);
        if (!name || name->before != channel->before || name->after != channel->after) continue;
        if (name->number < channel->number) return;
        if (name->number == channel->number) continue;
        if (is_used(stream.name, other.name)) return;
        if (other.finite > 0) others[name->number] = other.name;
      }
    }
    for (const auto& [number, name] : others) {
      const std::string to = column->before +
                             std::to_string(column->number + number - channel->number) +
                             column->after;
      if (has(to)) continue;
      found_.push_back({.to = to, .stream = said.stream, .channel = name});
    }
  }

  /// The joint of pos1 is 1 by its name; where --map says q:a1=pos1 it is a1, and so it is where
  /// vel1 and torque1 are found by their names.
  void learn_names() {
    const auto learn = [&](const std::vector<ColumnRule>& rules) {
      for (const ColumnRule& rule : rules) {
        if (!is_joint(rule.to)) continue;
        for (const LogStream& stream : log_.streams) {
          if (stream.name != rule.stream) continue;
          const std::string own = role_of(stream, rule.channel);
          if (own.find(':') != own.npos) said_as_[joint_of(own)].insert(joint_of(rule.to));
        }
      }
    };
    learn(said_);
    learn(found_);
  }

  /// A role with its joint called as --map calls it; empty where another joint was given its name.
  std::string as_said(const std::string& role) const {
    const std::size_t colon = role.find(':');
    if (colon == std::string::npos) return role;
    const std::string own = joint_of(role);
    const auto found = said_as_.find(own);
    if (found != said_as_.end() && found->second.size() == 1) {
      return role.substr(0, colon + 1) + *found->second.begin();
    }
    const bool taken = std::any_of(said_as_.begin(), said_as_.end(), [&](const auto& other) {
      return other.first != own && other.second.contains(own);
    });
    return taken ? "" : role;
  }

  bool has_joints(const LogStream& stream) const {
    return std::any_of(stream.channels.begin(), stream.channels.end(), [&](const auto& channel) {
      return channel.finite > 0 && is_joint(role_of(stream, channel.name));
    });
  }

  /// Streams of --use where one of them has joints; else all.
  std::vector<const LogStream*> usable() const {
    std::vector<const LogStream*> all, used;
    for (const LogStream& stream : log_.streams) {
      all.push_back(&stream);
      const bool named = std::find(use_.begin(), use_.end(), stream.name) != use_.end();
      if (named && has_joints(stream)) used.push_back(&stream);
    }
    return used.empty() ? all : used;
  }

  /// The currents of joints without torques stand in their place.
  void take_currents() {
    std::string first;
    for (const LogStream* stream : usable()) {
      for (const LogChannel& channel : stream->channels) {
        const std::string role = as_said(role_of(*stream, channel.name));
        if (!role.starts_with("current:") || channel.finite == 0) continue;
        const std::string joint = role.substr(role.find(':'));
        if (has("tau" + joint) || (!has("q" + joint) && !has("qd" + joint))) continue;
        if (is_used(stream->name, channel.name)) continue;
        found_.push_back({.to = "tau" + joint, .stream = stream->name, .channel = channel.name});
        if (first.empty()) first = channel.name;
      }
    }
    if (!first.empty()) {
      proposal_->notes.push_back("currents stand for torques, from " + shown(first) +
                                 " on; else say --map tau:…=CHANNEL");
    }
  }

  void by_name() {
    std::map<std::string, std::string> stream_of;
    for (const LogStream* usable_stream : usable()) {
      const LogStream& stream = *usable_stream;
      for (const LogChannel& channel : stream.channels) {
        const std::string role = as_said(role_of(stream, channel.name));
        if (!is_joint(role) || channel.finite == 0) continue;
        if (is_used(stream.name, channel.name)) continue;
        const auto other = stream_of.find(role);
        if (other != stream_of.end() && other->second != stream.name) {
          twice_ = {other->second, stream.name};
        }
        if (has(role)) continue;
        stream_of[role] = stream.name;
        found_.push_back({.to = role, .stream = stream.name, .channel = channel.name});
      }
    }
  }

  /// Columns as these tools write them, of joints of any name: q_LJ3 beside tau_LJ3. (q_x beside
  /// tau_x is a part of a quaternion and a torque of a wrench.)
  void by_pairs() {
    for (const LogStream* stream : usable()) {
      std::map<std::string, std::string> names[3];  // of q_, qd_ and tau_, by the joint
      const std::string quantities[] = {"q", "qd", "tau"};
      for (const LogChannel& channel : stream->channels) {
        const std::string own = channel.name.substr(channel.name.find_last_of("./") + 1);
        for (int k = 0; k < 3; ++k) {
          const std::string prefix = quantities[k] + "_";
          if (!own.starts_with(prefix) || channel.finite == 0) continue;
          const std::string joint = own.substr(prefix.size());
          const bool part = joint.size() == 1 && joint.find_first_of("wxyz") != joint.npos;
          if (!joint.empty() && !part && !is_used(stream->name, channel.name)) {
            names[k][joint] = channel.name;
          }
        }
      }
      for (const auto& [joint, position] : names[0]) {
        if (!names[2].contains(joint)) continue;
        for (int k = 0; k < 3; ++k) {
          if (!names[k].contains(joint)) continue;
          const std::string& channel = names[k].at(joint);
          found_.push_back(
              {.to = quantities[k] + ":" + joint, .stream = stream->name, .channel = channel});
        }
      }
      if (!found_.empty()) return;
    }
  }

  /// The one joint of a log in which nothing else is known: a stream with one position and one
  /// torque, or current, which are called so and nothing else.
  void only_joint() {
    for (const LogStream& stream : log_.streams) {
      std::map<std::string, Names> channels;  // by quantity
      for (const LogChannel& channel : stream.channels) {
        const std::string own = channel.name.substr(channel.name.find_last_of("./") + 1);
        const std::string quantity = lone_quantity(words_of_name(own));
        if (!quantity.empty() && channel.finite > 0) channels[quantity].push_back(channel.name);
      }
      const bool torque = !channels["tau:"].empty();
      const Names& efforts = torque ? channels["tau:"] : channels["current:"];
      if (channels["q:"].size() != 1 || efforts.size() != 1) continue;
      const auto add = [&](const char* quantity, const std::string& channel) {
        found_.push_back(
            {.to = std::string(quantity) + "1", .stream = stream.name, .channel = channel});
      };
      add("q:", channels["q:"][0]);
      if (channels["qd:"].size() == 1) add("qd:", channels["qd:"][0]);
      add("tau:", efforts[0]);
      proposal_->notes.push_back("taken for the position and the " +
                                 std::string(torque ? "torque" : "current") +
                                 " of one joint: " + shown(channels["q:"][0]) + " and " +
                                 shown(efforts[0]) + "; else say --map");
      return;
    }
  }

  /// Beside joints that were said, of two channels and more, a channel is a joint's where another
  /// one is that joint's as well: a drive's other analog channels are no joints.
  void leave_lone() {
    std::map<std::string, int> known;
    const auto count = [&](const std::vector<ColumnRule>& rules) {
      for (const ColumnRule& rule : rules) {
        if (is_joint(rule.to)) ++known[joint_of(rule.to)];
      }
    };
    count(said_);
    count(found_);
    const bool together = std::any_of(said_.begin(), said_.end(), [&](const ColumnRule& rule) {
      return is_joint(rule.to) && known[joint_of(rule.to)] > 1;
    });
    if (!together) return;
    std::erase_if(found_, [&](const ColumnRule& rule) {
      return is_joint(rule.to) && known[joint_of(rule.to)] == 1;
    });
  }

  void ask() {
    if (!twice_.empty()) {
      proposal_->questions.push_back("several streams have joints: say --use " + twice_[0] +
                                     " or " + twice_[1]);
    }
    std::set<std::string> angles;
    bool torques = false;
    const auto count = [&](const std::vector<ColumnRule>& rules) {
      for (const ColumnRule& rule : rules) {
        if (rule.to.starts_with("q:")) angles.insert(rule.to);
        torques = torques || rule.to.starts_with("tau:");
      }
    };
    count(said_);
    count(found_);
    if (angles.empty() || torques) return;
    const std::string torque = "tau" + angles.begin()->substr(1);
    proposal_->notes.push_back("joints without torques: say --map " + torque +
                               "=CHANNEL for torques or currents; those counted on from it follow");
  }

  const ForeignLog& log_;
  const std::vector<ColumnRule>& said_;
  const Names& use_;
  Proposal* proposal_;
  std::vector<ColumnRule> found_;
  std::map<std::string, std::set<std::string>> said_as_;  ///< by the joint's name in the log
  Names twice_;                                           ///< two streams that have one joint
};

}  // namespace

std::vector<ColumnRule> find_joints(const ForeignLog& log, const std::vector<ColumnRule>& taken,
                                    const std::vector<std::string>& use, Proposal* proposal) {
  return JointFinder(log, taken, use, proposal).run();
}

}  // namespace dcnn
