// SPDX-License-Identifier: Apache-2.0
// Predictions of a case's recordings under a set of effects, with what effects do not touch cached.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/case.h"
#include "diagnosis/member.h"

namespace dcnn {

/// One matrix (T, channels) per recording.
using Signals = std::vector<Eigen::MatrixXd>;

/// Those of the members, then those that the simulator has as it was given.
std::vector<EffectSpec> effects_of(const Case& study, const std::vector<Member>& members);

class Chain {
 public:
  Chain(const Case& study, std::vector<Member> members);

  const std::vector<Member>& members() const { return members_; }
  const Signals& prediction() const { return prediction_; }
  /// The prediction with one effect more, or with other numbers of one of the members: then
  /// `effect` is the same effect in the same place.
  Signals with(const Member& effect, std::optional<std::size_t> instead_of = {}) const;

 private:
  struct Stages {
    ToolModel model;             // as the members change it
    Eigen::MatrixXd load;        // what is carried before the forces on the tool
    Eigen::MatrixXd carried;     // what effects that an axis' drive carries add; of a tool no rows
    Wrench forced;               // after them
    std::vector<Wrench> pushes;  // what each effect adds there; no rows where it acts elsewhere
  };
  Eigen::MatrixXd finish(const Log& log, const Stages& stages, Wrench wrench,
                         const std::vector<EffectSpec>& effects) const;
  Stages prepare(const Log& log, const std::vector<EffectSpec>& effects) const;
  Wrench push_of(const EffectSpec& effect, const Log& log, const Stages& stages) const;

  const Case& study_;
  std::vector<Member> members_;
  std::vector<EffectSpec> specs_;  // of the members, in their order, and those that were given
  std::vector<Stages> stages_;     // per recording
  Signals prediction_;
};

/// What the effects make of the case's recordings.
Signals predict(const Case& study, const std::vector<Member>& members);

}  // namespace dcnn
