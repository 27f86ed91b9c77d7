// SPDX-License-Identifier: Apache-2.0
// The numbers of a sketch that a fit changes, each on a scale of its own.
#pragma once

#include <vector>

#include "discovery/data.h"

namespace dcnn::discovery {

/// A number of a sketch on the scale that it is searched on.
struct Handle {
  double* value;
  bool logarithmic;
  double low, high;
  double step;        // of a difference
  double most;        // of one Gauss-Newton step
  int of_piece = -1;  // of no factor

  double get() const;
  void set(double x) const;  ///< within the bounds
};

/// In the order of the law's numbers, without the amplitude and the references.
std::vector<Handle> handles_of(const Data& data, Sketch& sketch);

}  // namespace dcnn::discovery
