// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

void euler_orders(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (log.has_quaternion() || !log.is_wrist()) return;
  const struct {
    const char* order;
    bool reversed;
    const char* words;
  } kOrders[] = {{"zyx", true,
                  "Rz(gamma) Ry(beta) Rx(alpha): alpha and gamma are exchanged (roll, pitch, yaw)"},
                 {"xyz", false, "Rx(alpha) Ry(beta) Rz(gamma)"},
                 {"xyz", true, "Rx(gamma) Ry(beta) Rz(alpha)"},
                 {"zxy", false, "Rz(alpha) Rx(beta) Ry(gamma)"},
                 {"yxz", false, "Ry(alpha) Rx(beta) Rz(gamma)"},
                 {"zyz", false, "Rz(alpha) Ry(beta) Rz(gamma)"}};
  for (const auto& [order, reversed, words] : kOrders) {
    Reading reading = base;
    reading.orientation.order = order;
    reading.orientation.reversed = reversed;
    reading.channel = "alpha";
    reading.words = std::string("the angles mean ") + words + ", not Rz(alpha) Ry(beta) Rx(gamma)";
    out.push_back(reading);
  }
}

}  // namespace

const FaultKind euler_order_fault{
    "euler_order", true, "convert the angles, or log a quaternion", "", nullptr,
    euler_orders,  true};

}  // namespace dcnn::check
