// SPDX-License-Identifier: Apache-2.0
// Tables of numbers as CSV: strict, locale-free, streaming.
#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <string>
#include <vector>

namespace dcnn {

/// Columns of numbers under unique names.
struct Table {
  std::vector<std::string> columns;
  Eigen::MatrixXd values;  ///< (rows, columns)
};

/// Reads a header row and rows of finite decimal numbers, comma-separated. Everything else is an
/// Error(kData) naming file, line, column and remedy. Accepted beside: CRLF, a
/// last row without line end, blank lines after the last row, spaces around a cell, a leading '+'.
Table read_csv(const std::filesystem::path& path);

/// Writes the shortest decimals that read back as the same doubles; replaced atomically.
void write_csv(const std::filesystem::path& path, const Table& table);

}  // namespace dcnn
