// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {
namespace {

/// One axis mirrored, or two exchanged. A motion whose accelerations are too small to see tells
/// nothing of them, and then they stay at their prior.
void position_orders(const Log& log, const Reading& base, std::vector<Reading>& out) {
  if (!log.has_all(kPosition) || !log.is_wrist()) return;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::Index a = (k + 1) % 3, b = (k + 2) % 3;
    Reading mirrored = base, exchanged = base;
    mirrored.position_axes.row(k) *= -1.0;
    mirrored.channel = kPosition[static_cast<std::size_t>(k)];
    mirrored.words = "column " + mirrored.channel + " has the wrong sign";
    exchanged.position_axes.row(a).swap(exchanged.position_axes.row(b));
    exchanged.channel = kPosition[static_cast<std::size_t>(std::min(a, b))];
    exchanged.words = "columns " + exchanged.channel + " and " +
                      kPosition[static_cast<std::size_t>(std::max(a, b))] + " are exchanged";
    out.push_back(mirrored);
    out.push_back(exchanged);
  }
}

}  // namespace

const FaultKind position_axes_fault{
    "position_axes", false, "rename the columns or turn the sign", "", nullptr,
    position_orders, true};

}  // namespace dcnn::check
