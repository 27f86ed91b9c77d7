// SPDX-License-Identifier: Apache-2.0
// Which mark is whose: rows of entries from left to right.
#pragma once

#include <string>
#include <vector>

#include "dcnn/experiment/report.h"
#include "experiment/svg_marks.h"

namespace dcnn {

class Legend {
 public:
  Legend() = default;
  /// Entries between two edges [px]; none where no series has a label.
  Legend(const Chart& chart, double left, double right);
  double height() const;  ///< 0 without entries
  /// SVG elements, the last row ending at `bottom`.
  std::string draw(const Chart& chart, double bottom) const;

 private:
  std::vector<Point> places_;  // of the entries, y from the first row
};

}  // namespace dcnn
