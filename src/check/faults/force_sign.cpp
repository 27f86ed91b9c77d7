// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

void force_signs(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.is_wrist()) return;
  for (Eigen::Index k = 0; k < 3; ++k) {
    Reading reading = base;
    reading.force_axes.row(k) *= -1.0;
    reading.channel = std::string("f") + "xyz"[k];
    reading.words = reading.channel + " has the wrong sign (a left-handed sensor frame)";
    out.push_back(reading);
  }
}

}  // namespace

const FaultKind force_sign_fault{
    "force_sign", true, "turn the sign of this column, and of its torque", "", nullptr,
    force_signs,  true};

}  // namespace dcnn::check
