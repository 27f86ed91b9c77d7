// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

std::vector<Fault> find_gaps(const Evidence& e) {
  if (e.log.step <= 0.0 || !e.log.smooth || e.log.segments.size() < 2) return {};
  const Segment& second = e.log.segments[1];
  Fault fault = fact_of(gaps_fault, "t",
                        std::to_string(e.log.segments.size() - 1) +
                            " gaps of more than 5 steps; the recording is split there");
  fault.interval_s = {e.log.t[second.begin - 1], e.log.t[second.begin]};
  return {fault};
}

}  // namespace

const FaultKind gaps_fault{"gaps", false, "nothing, where the gaps are few; else record again", "",
                           find_gaps};

}  // namespace dcnn::check
