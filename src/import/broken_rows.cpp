// SPDX-License-Identifier: Apache-2.0
#include "import/broken_rows.h"

#include <algorithm>
#include <cmath>

namespace dcnn {
namespace {

using Rows = std::vector<std::size_t>;

constexpr double kBroken = 0.01;  // of the rows at most
constexpr double kBeyond = 1e6;   // times the usual size: no sensor has that range
constexpr double kLeast = 1e12;   // beyond any reading: what is small at rest may be anything else

/// The longest part of the rows whose times increase.
Rows in_order(const Rows& rows, const std::vector<double>& times) {
  std::vector<std::size_t> ends;  // of increasing parts, by length: the place in `rows`
  std::vector<std::size_t> before(rows.size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto at =
        std::lower_bound(ends.begin(), ends.end(), times[rows[k]],
                         [&](std::size_t end, double t) { return times[rows[end]] < t; });
    if (at != ends.begin()) before[k] = *(at - 1);
    if (at == ends.end()) {
      ends.push_back(k);
    } else {
      *at = k;
    }
  }
  Rows kept;
  for (std::size_t k = ends.empty() ? rows.size() : ends.back(); k < rows.size(); k = before[k]) {
    kept.push_back(rows[k]);
  }
  std::reverse(kept.begin(), kept.end());
  return kept;
}

/// Without the ends of increasing times that are further off than the middle 98 % are long.
Rows without_far_ends(const Rows& rows, const std::vector<double>& times) {
  const auto few = static_cast<std::size_t>(kBroken * static_cast<double>(rows.size()));
  const std::size_t last = rows.size() - 1;
  const double length = times[rows[last - few]] - times[rows[few]];
  std::size_t from = 0, to = rows.size();
  for (std::size_t k = 0; k < few; ++k) {
    if (times[rows[k + 1]] - times[rows[k]] > length) from = k + 1;
    if (times[rows[last - k]] - times[rows[last - k - 1]] > length) to = last - k;
  }
  return {rows.begin() + static_cast<std::ptrdiff_t>(from),
          rows.begin() + static_cast<std::ptrdiff_t>(to)};
}

void drop_beyond(const std::vector<double>& column, Rows* rows) {
  std::vector<double> sizes;
  for (const std::size_t row : *rows) sizes.push_back(std::abs(column[row]));
  const auto usual = sizes.begin() + static_cast<std::ptrdiff_t>(
                                         (1.0 - kBroken) * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), usual, sizes.end());
  const double most = std::max(kLeast, kBeyond * *usual);
  std::erase_if(*rows, [&](std::size_t row) { return std::abs(column[row]) > most; });
}

}  // namespace

Rows unbroken_rows(const Rows& rows, const std::vector<double>& times,
                   const std::vector<std::vector<double>>& columns) {
  if (rows.size() < 2) return rows;
  Rows kept = rows;
  if (!times.empty()) kept = without_far_ends(in_order(rows, times), times);
  for (const std::vector<double>& column : columns) drop_beyond(column, &kept);
  const std::size_t lost = rows.size() - kept.size();
  return static_cast<double>(lost) > kBroken * static_cast<double>(rows.size()) ? rows : kept;
}

}  // namespace dcnn
