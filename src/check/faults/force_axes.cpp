#include <algorithm>
#include <array>

#include "check/kind.h"

namespace dcnn::check {
namespace {

/// "fx = +fy" for each row of a signed permutation.
std::string axes_words(const Eigen::Matrix3d& P) {
  std::string words;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      if (P(i, j) == 0.0) continue;
      words += std::string(i == 0 ? "" : ", ") + "xyz"[i] + " = " + (P(i, j) > 0 ? "f" : "-f") +
               "xyz"[j];
    }
  }
  const bool mirrored = P.determinant() < 0.0;
  return "the sensor's axes are " +
         std::string(mirrored ? "swapped or mirrored" : "turned by right angles") +
         " against the pose frame: " + words;
}

/// The signed permutations but for the identity, its negative and those of one sign.
void axis_orders(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.is_wrist()) return;
  std::array<Eigen::Index, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
      for (Eigen::Index i = 0; i < 3; ++i) {
        P(i, order[static_cast<std::size_t>(i)]) = (signs >> i & 1) ? -1.0 : 1.0;
      }
      const bool straight = order[0] == 0 && order[1] == 1;
      if (straight && std::abs(P.trace()) > 1.5) continue;
      if (straight && P.trace() > 0.5) continue;  // one sign: a fault of its own
      Reading reading = base;
      reading.force_axes = P * base.force_axes;
      reading.channel = "fx";
      reading.words = axes_words(P);
      // A mounting that nobody declared is no fault of the log.
      reading.harmless = P.determinant() > 0.0 && !log.declared.model;
      out.push_back(reading);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

}  // namespace

const FaultKind force_axes_fault{
    "force_axes",
    true,
    "rename the columns, or give the mounting as sensor.rotation_rpy in sim.json",
    "",
    nullptr,
    axis_orders,
    true};

}  // namespace dcnn::check
