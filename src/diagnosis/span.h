// SPDX-License-Identifier: Apache-2.0
// A stretch of a recording.
#pragma once

#include <cstddef>

namespace dcnn {

/// Rows of one recording that must not decide about anything.
struct Span {
  std::size_t log;
  double begin, end;  ///< s
  bool operator==(const Span&) const = default;
  bool holds(std::size_t recording, double t) const {
    return log == recording && t >= begin && t <= end;
  }
};

}  // namespace dcnn
