// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"
#include "check/statistics.h"

namespace dcnn::check {
namespace {

std::vector<Fault> find_clock_order(const Evidence& e) {
  if (e.log.t.size() < 2) return {};
  const Eigen::VectorXd steps = steps_of(e.log.t);
  const auto back = (steps.array() <= 0.0).count();
  if (back == 0) return {};
  return {fact_of(clock_order_fault, "t",
                  "t does not increase at " + std::to_string(back) + " of " +
                      std::to_string(steps.size()) +
                      " steps (repeated rows, or a clock that was set)")};
}

}  // namespace

const FaultKind clock_order_fault{
    "clock_order", true,
    "sort the rows, remove repeated ones, or cut the log where its clock was set", "",
    find_clock_order};

}  // namespace dcnn::check
