// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "check/kind.h"

namespace dcnn::check {
namespace {

/// Conventions of Denavit and Hartenberg, of makers and of URDFs differ by right angles.
void joint_zeros(const Log& log, const Reading& base, std::vector<Reading>& out) {
  const struct {
    double turns;
    const char* degrees;
  } kZeros[] = {{0.25, "90"}, {-0.25, "-90"}, {0.5, "180"}};
  for (std::size_t j = 0; j < log.arm.size(); ++j) {
    const Joint& joint = log.joints[base.arm.joint[j]];
    if (log.declared.arm->joints[j].slides) continue;
    for (const auto& [turns, degrees] : kZeros) {
      Reading reading = base;
      reading.arm.zero[static_cast<Eigen::Index>(j)] += turns * 2.0 * std::numbers::pi;
      reading.channel = joint.position;
      reading.words = log.declared.arm->joints[j].name + ": the arm described is at " + degrees +
                      " degrees where " + joint.position + " is 0";
      out.push_back(std::move(reading));
    }
  }
}

}  // namespace

const FaultKind joint_zero_fault{"joint_zero",
                                 true,
                                 "add this angle to the column, or turn the joint's origin in the "
                                 "description",
                                 "",
                                 nullptr,
                                 joint_zeros,
                                 true};

}  // namespace dcnn::check
