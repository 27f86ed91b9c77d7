// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {

const std::vector<const FaultKind*>& fault_kinds() {
  static const std::vector<const FaultKind*> kinds = {
#define FAULT(id) &id##_fault,
#include "check/faults.def"
#undef FAULT
  };
  return kinds;
}

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  for (const FaultKind* kind : fault_kinds()) names.emplace_back(kind->id);
  return names;
}

Fault fault_of(const FaultKind& kind, double probability, const std::string& channel,
               const std::string& words) {
  return {kind.id, probability, channel, std::nullopt, words, kind.remedy, kind.flag, kind.stops};
}

Fault fact_of(const FaultKind& kind, const std::string& channel, const std::string& words) {
  return fault_of(kind, 1.0, channel, words);
}

}  // namespace dcnn::check
