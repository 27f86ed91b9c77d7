// SPDX-License-Identifier: Apache-2.0
#include "check/held.h"

#include <algorithm>

namespace dcnn::check {
namespace {

void find_held_group(const Log& log, const std::vector<std::string>& names,
                     std::vector<Fault>& out) {
  const Held held = held_of(log, names);
  if (held.probability <= 0.0) return;
  out.push_back(fault_of(held_fault, held.probability, names[0],
                         "the values of " + names[0] +
                             (names.size() > 1 ? " and its companions" : "") + " are new every " +
                             std::to_string(held.length) + " rows only, held in between"));
}

std::vector<Fault> find_held(const Evidence& e) {
  std::vector<Fault> out;
  // Without a clock there is no rate: several rows of one pose at rest are alike by right.
  if (!e.log.smooth || e.log.step <= 0.0) return out;
  std::vector<std::vector<std::string>> groups = e.log.sensors();
  groups.push_back(e.log.positions());
  for (const auto& names : groups) {
    if (!names.empty()) find_held_group(e.log, names, out);
  }
  // One channel alone changes no row in which its companions are new.
  for (const auto& names : groups) {
    if (names.size() < 2) continue;
    for (const std::string& name : names) find_held_group(e.log, {name}, out);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Fault& a, const Fault& b) { return a.probability > b.probability; });
  if (out.size() > 1) out.resize(1);
  return out;
}

}  // namespace

const FaultKind held_fault{"held", false,
                           "log every source at the rate it has, or keep every k-th row alone", "",
                           find_held};

}  // namespace dcnn::check
