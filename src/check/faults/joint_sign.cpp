// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

/// The position alone, or position and torque: a joint that counts the other way.
void joint_signs(const Log& log, const Reading& base, std::vector<Reading>& out) {
  for (std::size_t j = 0; j < log.arm.size(); ++j) {
    const auto k = static_cast<Eigen::Index>(j);
    const Joint& joint = log.joints[base.arm.joint[j]];
    for (const bool torque_too : {false, true}) {
      Reading reading = base;
      reading.arm.sign[k] *= -1.0;
      if (torque_too) reading.arm.torque[k] *= -1.0;
      reading.channel = joint.position;
      reading.words = log.declared.arm->joints[j].name + ": " + joint.position +
                      (torque_too ? " and " + joint.measured + " count" : " counts") +
                      " the other way round than the arm described";
      out.push_back(std::move(reading));
    }
  }
}

}  // namespace

const FaultKind joint_sign_fault{"joint_sign",
                                 true,
                                 "turn the sign of these columns, or the joint's axis in the "
                                 "description",
                                 "",
                                 nullptr,
                                 joint_signs,
                                 true};

}  // namespace dcnn::check
