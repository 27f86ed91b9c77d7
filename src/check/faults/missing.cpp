// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"
#include "core/lists.h"

namespace dcnn::check {
namespace {

using Names = std::vector<std::string>;

/// Those of a vector that are not there, where most are: x alone may be a slide.
Names lacking(const Log& log, const Names& vector) {
  Names list;
  for (const std::string& name : vector) {
    if (!log.has(name)) list.push_back(name);
  }
  return 2 * list.size() < vector.size() ? list : Names{};
}

std::vector<Fault> find_missing(const Evidence& e) {
  const Log& log = e.log;
  if (!log.joints.empty()) return {};
  std::vector<Fault> faults;
  const auto add = [&](const std::string& channel, const std::string& words) {
    faults.push_back(fact_of(missing_fault, channel, words));
  };
  for (const Names& vector :
       {Names{"fx", "fy", "fz"}, Names{"tx", "ty", "tz"}, Names{"x", "y", "z"},
        Names{"alpha", "beta", "gamma"}, Names{"qw", "qx", "qy", "qz"}}) {
    const Names list = lacking(log, vector);
    if (!list.empty()) {
      add(list.front(), "of " + joined(vector) + " the log has no " + joined(list));
    }
  }
  const bool felt = log.has_all({"fx", "fy", "fz"});
  if (faults.empty() && felt && !log.has_pose() && !log.has("fx_sim")) {
    add("alpha", "forces without an orientation: no alpha, beta, gamma and no qw, qx, qy, qz");
  }
  if (faults.empty() && !felt && log.has_pose() && !log.has("tx")) {
    add("fx", "a pose without forces: no fx, fy, fz");
  }
  if (log.table.values.rows() < 2) add("t", "a single row");
  return faults;
}

}  // namespace

const FaultKind missing_fault{"missing", false,
                              "log it, or say which channel it is (dcnn-import --map fx=CHANNEL)",
                              "", find_missing};

}  // namespace dcnn::check
