// SPDX-License-Identifier: Apache-2.0
#include "import/stream_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "dcnn/core/excerpt.h"
#include "import/broken_rows.h"
#include "import/clocks.h"
#include "import/units.h"

namespace dcnn {
namespace {

/// Adds what a register lost whenever it began anew: steps beyond half its range.
void unwrap_register(double range, std::vector<double>* values) {
  double turns = 0.0, last = std::numeric_limits<double>::quiet_NaN();
  for (double& value : *values) {
    if (std::isnan(value)) continue;
    const double raw = value;
    if (raw - last > 0.5 * range) turns -= range;
    if (raw - last < -0.5 * range) turns += range;
    last = raw;
    value += turns;
  }
}

std::vector<double> column_values(const ForeignLog& log, const LogStream& stream,
                                  const ColumnRule& rule) {
  const Index at = stream.find(rule.channel);
  require(at >= 0, Exit::kData, log.file, ": ", shown(stream.name), " has no channel ",
          shown(rule.channel), ", which is to be ", rule.to, "; see dcnn-import --dry-run");
  std::vector<double> values = stream.channels[static_cast<std::size_t>(at)].values;
  require(static_cast<Index>(values.size()) == stream.rows, Exit::kData, log.file, ": channel ",
          shown(rule.channel), " was not kept");
  if (rule.wrap > 0.0) unwrap_register(rule.wrap, &values);
  const auto unit = rule.unit.empty() ? LogUnit() : find_unit(rule.unit);
  require(unit.has_value(), Exit::kData, log.file, ": ", shown(rule.unit), " of column ", rule.to,
          " is no unit that is known here");
  for (double& value : values) {
    value = (value - rule.offset) * rule.gain * unit->factor + unit->origin;
  }
  return values;
}

const LogStream& stream_of(const ForeignLog& log, const std::string& name) {
  for (const LogStream& stream : log.streams) {
    if (stream.name == name) return stream;
  }
  std::string all;
  for (const LogStream& stream : log.streams) all += (all.empty() ? "" : ", ") + stream.name;
  fail(Exit::kData, log.file, ": has no stream ", shown(name), "; it has ", excerpt(all, 200));
}

/// Without rows that repeat the one before in time and in every column: a line written twice.
void drop_twins(const LogStream& stream, const std::vector<double>& times,
                const std::vector<std::vector<double>>& columns, std::vector<std::size_t>* rows,
                std::vector<std::string>* notes) {
  const auto same = [&](std::size_t a, std::size_t b) {
    return times[a] == times[b] &&
           std::all_of(columns.begin(), columns.end(),
                       [&](const auto& column) { return column[a] == column[b]; });
  };
  const std::size_t before = rows->size();
  rows->erase(std::unique(rows->begin(), rows->end(), same), rows->end());
  if (const std::size_t twins = before - rows->size(); twins > 0) {
    notes->push_back(stream.name + ": " + std::to_string(twins) +
                     (twins == 1 ? " row repeats" : " rows repeat") +
                     " the one before, time and all: left out");
  }
}

/// Rows in the order in which they are used: numbers everywhere, times increasing.
std::vector<std::size_t> usable_rows(const ForeignLog& log, const LogStream& stream,
                                     const std::vector<double>& times,
                                     const std::vector<std::vector<double>>& columns,
                                     std::vector<std::string>* notes) {
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < static_cast<std::size_t>(stream.rows); ++k) {
    const bool missing = std::any_of(columns.begin(), columns.end(),
                                     [&](const auto& column) { return !std::isfinite(column[k]); });
    if (!missing && (times.empty() || std::isfinite(times[k]))) rows.push_back(k);
  }
  if (const std::size_t lost = static_cast<std::size_t>(stream.rows) - rows.size(); lost > 0) {
    notes->push_back(stream.name + ": " + std::to_string(lost) + " of " +
                     std::to_string(stream.rows) +
                     " rows have no number in a used channel: left out");
  }
  require(!rows.empty(), Exit::kData, log.file, ": ", shown(stream.name),
          " has no row with a number in every used channel");
  if (times.empty()) return rows;
  const bool message = !stream.received.empty();
  if (message) {
    const auto earlier = [&](std::size_t a, std::size_t b) { return times[a] < times[b]; };
    if (!std::is_sorted(rows.begin(), rows.end(), earlier)) {
      std::stable_sort(rows.begin(), rows.end(), earlier);
    }
    const std::size_t before = rows.size();
    rows.erase(std::unique(rows.begin(), rows.end(),
                           [&](std::size_t a, std::size_t b) { return times[a] == times[b]; }),
               rows.end());
    if (rows.size() < before) {
      notes->push_back(stream.name + ": " + std::to_string(before - rows.size()) +
                       " messages repeat a stamp: left out");
    }
  }
  if (!message) {
    drop_twins(stream, times, columns, &rows, notes);
    std::vector<std::size_t> kept = unbroken_rows(rows, times, columns);
    if (const std::size_t lost = rows.size() - kept.size(); lost > 0) {
      const auto first = std::mismatch(kept.begin(), kept.end(), rows.begin()).second;
      notes->push_back(stream.name + ": " + std::to_string(lost) +
                       " broken rows (a time out of order, or a number out of all proportion), "
                       "the first is row " +
                       std::to_string(*first + 1) + ": left out");
    }
    rows = std::move(kept);
  }
  for (std::size_t k = 1; k < rows.size(); ++k) {
    if (times[rows[k]] > times[rows[k - 1]]) continue;  // words are made for a message only
    fail(Exit::kData, log.file, ": ", shown(stream.name), ": the clock goes from ",
         times[rows[k - 1]], " to ", times[rows[k]], " s in row ", rows[k] + 1,
         "; cut the log there, or give --rate for a clock with too few digits");
  }
  return rows;
}

struct NamedColumns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
};

StreamTable table_of(const ForeignLog& log, const LogStream& stream, const NamedColumns& columns,
                     const std::vector<double>& times, std::vector<std::string>* notes) {
  StreamTable table;
  table.stream = stream.name;
  table.columns = columns.names;
  const auto rows = usable_rows(log, stream, times, columns.values, notes);
  table.values.resize(static_cast<Index>(rows.size()), static_cast<Index>(columns.names.size()));
  for (std::size_t c = 0; c < columns.names.size(); ++c) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      table.values(static_cast<Index>(k), static_cast<Index>(c)) = columns.values[c][rows[k]];
    }
  }
  if (times.empty()) return table;
  table.t.reserve(rows.size());
  for (const std::size_t row : rows) table.t.push_back(times[row]);
  return table;
}

/// Columns with numbers in the same rows: those of which half of the rows with a number are rows
/// with a number of the group's first.
std::vector<std::vector<std::size_t>> sampled_together(
    const std::vector<std::vector<double>>& columns) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    bool placed = false;
    for (auto& group : groups) {
      const auto& first = columns[group[0]];
      std::size_t both = 0, own = 0, others = 0;
      for (std::size_t row = 0; row < first.size(); ++row) {
        const bool a = std::isfinite(first[row]), b = std::isfinite(columns[k][row]);
        both += a && b;
        own += b;
        others += a;
      }
      if (2 * both < std::min(own, others)) continue;
      group.push_back(k);
      placed = true;
      break;
    }
    if (!placed) groups.push_back({k});
  }
  if (groups.empty()) groups.emplace_back();
  return groups;
}

}  // namespace

Index StreamTable::find(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  return found == columns.end() ? -1 : found - columns.begin();
}

void StreamTable::drop(const std::vector<std::string>& names) {
  std::vector<Index> kept;
  std::vector<std::string> rest;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (std::find(names.begin(), names.end(), columns[k]) != names.end()) continue;
    kept.push_back(static_cast<Index>(k));
    rest.push_back(columns[k]);
  }
  if (rest.size() == columns.size()) return;
  columns = std::move(rest);
  values = Eigen::MatrixXd(values(Eigen::all, kept));
}

void StreamTable::add(const std::vector<std::string>& names) {
  const Index before = values.cols();
  for (const std::string& name : names) {
    if (!has(name)) columns.push_back(name);
  }
  const auto all = static_cast<Index>(columns.size());
  if (all == before) return;
  values.conservativeResize(Eigen::NoChange, all);
  values.rightCols(all - before).setZero();
}

void StreamTable::set(const std::string& column, const Eigen::VectorXd& numbers) {
  Index at = find(column);
  if (at < 0) {
    at = static_cast<Index>(columns.size());
    columns.push_back(column);
    values.conservativeResize(numbers.size(), at + 1);
  }
  values.col(at) = numbers;
}

std::vector<StreamTable> make_stream_tables(const ForeignLog& log, const Recipe& recipe,
                                            const ClockRule& clock,
                                            std::vector<std::string>* notes) {
  const LogStream& stream = stream_of(log, clock.stream);
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  for (const ColumnRule& rule : recipe.columns) {
    if (rule.stream != stream.name) continue;
    names.push_back(rule.to);
    columns.push_back(column_values(log, stream, rule));
  }
  const std::vector<double> times = clock_times(stream, clock, log.file);
  const auto groups = sampled_together(columns);
  if (groups.size() == 1 || times.empty()) {
    std::vector<StreamTable> whole;  // an initializer list would copy its numbers
    whole.push_back(table_of(log, stream, {std::move(names), std::move(columns)}, times, notes));
    return whole;
  }
  std::vector<StreamTable> tables;
  for (const auto& group : groups) {
    NamedColumns part;
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < times.size(); ++row) {
      if (std::isfinite(columns[group[0]][row])) rows.push_back(row);
    }
    const auto rows_of = [&](const std::vector<double>& from) {
      std::vector<double> values;
      for (const std::size_t row : rows) values.push_back(from[row]);
      return values;
    };
    for (const std::size_t column : group) {
      part.names.push_back(names[column]);
      part.values.push_back(rows_of(columns[column]));
    }
    LogStream own;
    own.name = stream.name + " (" + part.names[0] + ", …)";
    own.rows = static_cast<Index>(rows.size());
    own.received = stream.received.empty() ? std::vector<double>() : rows_of(stream.received);
    tables.push_back(table_of(log, own, part, rows_of(times), notes));
  }
  return tables;
}

}  // namespace dcnn
