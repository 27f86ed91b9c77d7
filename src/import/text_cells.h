// SPDX-License-Identifier: Apache-2.0
// Cells of a text in any dialect.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dcnn {

enum class CellKind { kNumber, kMissing, kText };

/// Cells of one line. Quotes protect separators; ' ' separates by runs of blanks and tabs; a ';'
/// that ends a line and separates nothing is no part of its last cell.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>* cells);

/// A decimal number with '.' or ',' (`decimal`), a date or a time of day (clock_seconds), or one of
/// the words for a missing value (NaN).
CellKind read_cell(std::string_view cell, char decimal, double* value);

/// "2024-05-01T12:00:00.25+02:00" (ISO 8601, UTC where no zone is given) or "01.05.2024 12:00:00"
/// in s since 1970, "12:00:00.25" in s since midnight.
std::optional<double> clock_seconds(std::string_view text);

/// Without blanks, tabs and quotes around.
std::string_view bare(std::string_view cell);

}  // namespace dcnn
