// SPDX-License-Identifier: Apache-2.0
// The numbers of a chart for the plot that is drawn over its SVG where the page runs scripts.
#pragma once

#include <string>

#include "dcnn/experiment/report.h"

namespace dcnn {

/// A JSON text safe inside <script>: title, x, y, labels, colors, rows; empty for a chart that is
/// no set of lines over one axis. Long lines are reduced to the least and the largest value of each
/// of 3000 columns.
std::string plot_data(const Chart& chart);

}  // namespace dcnn
