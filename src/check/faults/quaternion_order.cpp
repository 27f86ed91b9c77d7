// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

void quaternion_orders(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.has_quaternion() || !log.is_wrist()) return;
  Reading reading = base;
  reading.orientation.order = base.orientation.order == "wxyz" ? "xyzw" : "wxyz";
  reading.channel = "qw";
  reading.words = "the quaternion's scalar stands last: columns qw,qx,qy,qz hold x,y,z,w";
  out.push_back(reading);
}

}  // namespace

const FaultKind quaternion_order_fault{
    "quaternion_order", true, "rename the columns to qx,qy,qz,qw", "", nullptr, quaternion_orders};

}  // namespace dcnn::check
