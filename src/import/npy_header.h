// SPDX-License-Identifier: Apache-2.0
// The head of an array of NumPy.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

struct NpyField {
  std::string name;  ///< of a structured array
  char kind = 'f';   ///< f i u b
  int bytes = 8;
  bool big = false;
};

struct NpyHeader {
  std::vector<NpyField> fields;
  bool fortran = false;
  Index rows = 0, columns = 1;
  Index matrix = 0;  ///< order of the 3 x 3 or 4 x 4 matrices that the rows are; 0: they are none

  std::uint64_t row_bytes() const;  ///< of one element
  std::uint64_t bytes() const;
  /// Appends the numbers of a row.
  void read_row(std::string_view data, Index row, const std::string& place,
                std::vector<double>* out) const;
};

/// An array of texts, objects, complex numbers or more than two dimensions.
struct NotNumbers : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }".
NpyHeader parse_npy_header(std::string_view text, const std::string& place);

}  // namespace dcnn
