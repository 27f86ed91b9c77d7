// SPDX-License-Identifier: Apache-2.0
// Logs that are arrays of numbers: NumPy, MATLAB, JSON.
#pragma once

#include <string>
#include <vector>

#include "import/log_builder.h"

namespace dcnn {

/// Columns of one length.
struct NumberArray {
  std::vector<std::string> channels;
  std::vector<std::vector<double>> columns;
  Index rows = 0;
};

/// "force[0]" of an array with several columns.
std::string element_name(const std::string& array, Index column, Index columns);

/// Names of the elements of `order` x `order` matrices (3: a rotation, 4: with a translation in the
/// last column), counted by columns or by rows: "R.r11", "T.position.x".
std::vector<std::string> matrix_names(const std::string& array, Index order, bool by_columns);

/// Arrays of one length are one stream, called `name` or, where that is empty, by their length's
/// rank ("arrays1": the longest, "file2/arrays1" in the second file), which the next log has, too.
void add_number_arrays(const std::vector<NumberArray>& arrays, const std::string& name,
                       LogBuilder& builder);

}  // namespace dcnn
