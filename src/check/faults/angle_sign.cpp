// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

void angle_signs(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (log.has_quaternion() || !log.is_wrist()) return;
  for (Eigen::Index k = 0; k < 3; ++k) {
    Reading reading = base;
    reading.orientation.sign[k] *= -1.0;
    reading.channel = kEuler[static_cast<std::size_t>(k)];
    reading.harmless = k == 0;  // gravity does not see alpha: little evidence, little harm
    reading.words = reading.channel + " has the wrong sign";
    out.push_back(reading);
  }
}

}  // namespace

const FaultKind angle_sign_fault{"angle_sign", true, "turn the sign of this column", "", nullptr,
                                 angle_signs,  true};

}  // namespace dcnn::check
