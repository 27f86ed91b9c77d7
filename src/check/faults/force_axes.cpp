// SPDX-License-Identifier: Apache-2.0
#include "check/axes.h"
#include "check/kind.h"

namespace dcnn::check {
namespace {

std::string words_of(const Eigen::Matrix3d& P) {
  const bool mirrored = P.determinant() < 0.0;
  return "the sensor's axes are " +
         std::string(mirrored ? "swapped or mirrored" : "turned by right angles") +
         " against the pose frame: " + axes_words(P, "f");
}

/// The signed permutations but for the identity, its negative and those of one sign, which are
/// faults of their own.
void axis_orders(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.is_wrist()) return;
  for (const Eigen::Matrix3d& P : signed_permutations()) {
    if (P.isDiagonal() && (P.trace() > 0.5 || P.trace() < -1.5)) continue;
    Reading reading = base;
    reading.force_axes = P * base.force_axes;
    reading.channel = "fx";
    reading.words = words_of(P);
    // A mounting that nobody declared is no fault of the log.
    reading.harmless = P.determinant() > 0.0 && !log.declared.model;
    out.push_back(reading);
  }
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
