// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include "check/kind.h"

namespace dcnn::check {
namespace {

using Order = std::vector<std::size_t>;

void add_order(const Log& log, const Reading& base, const Order& order, const std::string& words,
               std::vector<Reading>& out) {
  Reading reading = base;
  for (std::size_t j = 0; j < order.size(); ++j) reading.arm.joint[j] = base.arm.joint[order[j]];
  const bool known = std::any_of(out.begin(), out.end(), [&](const Reading& other) {
    return other.arm.joint == reading.arm.joint;
  });
  if (known || reading.arm.joint == base.arm.joint) return;
  reading.channel = log.joints[base.arm.joint[0]].position;
  reading.words = words;
  out.push_back(std::move(reading));
}

/// Two joints exchanged, all reversed, and the order of the alphabet, in which ROS logs them.
void joint_orders(const Log& log, const Reading& base, std::vector<Reading>& out) {
  const std::size_t joints = log.arm.size();
  if (joints < 2) return;
  Order own(joints);
  std::iota(own.begin(), own.end(), std::size_t{0});
  const auto name = [&](std::size_t j) { return log.declared.arm->joints[j].name; };
  Order sorted = own;
  std::sort(sorted.begin(), sorted.end(),
            [&](std::size_t a, std::size_t b) { return name(a) < name(b); });
  Order place(joints);  // columns in the order of the alphabet: where each joint's are
  for (std::size_t k = 0; k < joints; ++k) place[sorted[k]] = k;
  add_order(log, base, place,
            "the joints' columns are in the order of the alphabet, not in that of the arm", out);
  for (std::size_t a = 0; a < joints; ++a) {
    for (std::size_t b = a + 1; b < joints; ++b) {
      Order order = own;
      std::swap(order[a], order[b]);
      add_order(log, base, order,
                "the columns of " + name(a) + " and " + name(b) + " are exchanged", out);
    }
  }
  const Order reversed(own.rbegin(), own.rend());
  add_order(log, base, reversed, "the joints' columns begin at the flange, not at the base", out);
}

}  // namespace

const FaultKind joint_order_fault{"joint_order",
                                  true,
                                  "name the columns of each joint in --system, by the names that "
                                  "the URDF has",
                                  "",
                                  nullptr,
                                  joint_orders,
                                  true};

}  // namespace dcnn::check
