// SPDX-License-Identifier: Apache-2.0
// Scales of a chart: from values to places, with round ticks.
#pragma once

#include <string>
#include <vector>

namespace dcnn {

struct Tick {
  double value;
  std::string label;
};

/// A linear or logarithmic axis over [low, high].
struct ChartAxis {
  double low = 0, high = 1;
  bool log = false;
  std::vector<Tick> ticks;
  std::string multiplier;  ///< "×10⁻³" where the labels are thousandths

  /// 0 at low, 1 at high; what a logarithmic axis cannot show lies at 0.
  double place(double value) const;
};

/// About `wanted` ticks at 1, 2 or 5 times a power of ten inside [low, high]; `outward` extends the
/// range to whole ticks. An empty range is widened.
ChartAxis linear_axis(double low, double high, int wanted, bool outward);

/// Whole decades around [low, high], both positive; of two decades only what is needed, in steps of
/// 1, 2 and 5.
ChartAxis log_axis(double low, double high);

/// One tick per word, at 0, 1, …
ChartAxis category_axis(const std::vector<std::string>& words);

}  // namespace dcnn
