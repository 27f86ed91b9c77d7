// SPDX-License-Identifier: Apache-2.0
#include "dcnn/import/summary.h"

#include <algorithm>
#include <array>
#include <iomanip>

#include "dcnn/core/error.h"
#include "dcnn/core/excerpt.h"
#include "import/clocks.h"
#include "import/column_units.h"
#include "import/roles.h"
#include "import/units.h"

namespace dcnn {
namespace {

constexpr std::size_t kMostUnused = 12;

const ColumnRule* rule_for(const Recipe& recipe, const LogStream& stream,
                           const std::string& channel) {
  for (const ColumnRule& rule : recipe.columns) {
    if (rule.stream == stream.name && rule.channel == channel) return &rule;
  }
  return nullptr;
}

const ClockRule* clock_for(const Recipe& recipe, const LogStream& stream) {
  for (const ClockRule& rule : recipe.clocks) {
    if (rule.stream == stream.name) return &rule;
  }
  return nullptr;
}

std::string number_text(double value) {
  std::ostringstream text;
  text << std::setprecision(5) << value;
  return text.str();
}

std::string clock_words(const LogStream& stream, const ClockRule& rule, const std::string& file) {
  if (rule.kind == "none") return "no clock (static poses, or say --rate or --clock)";
  const ClockFigures f = clock_figures(clock_times(stream, rule, file));
  std::ostringstream words;
  const auto count = [&](Index n, const char* one, const char* many) {
    if (n > 0) words << ", " << n << " " << (n == 1 ? one : many);
  };
  words << std::setprecision(4);
  if (f.step > 0.0) {
    words << 1.0 / f.step << " Hz, " << f.end - f.begin << " s";
  } else {
    words << "one time only, no rate";
  }
  count(f.gaps, "gap", "gaps");
  count(f.repeats, "repeated time", "repeated times");
  count(f.backward, "step back", "steps back");
  if (f.off > 0.0) words << ", " << 100.0 * f.off << " % of steps off by more than 20 %";
  words << "; clock: " << rule.kind;
  if (rule.kind == "column") words << " '" << excerpt(rule.channel, 40) << "' in " << rule.unit;
  if (!rule.why.empty()) words << " (" << rule.why << ")";
  if (rule.assumed) words << " ASSUMED";
  if (rule.offset != 0.0) words << ", " << rule.offset << " s added";
  return words.str();
}

using TableRow = std::vector<std::string>;

void print_table(const std::vector<TableRow>& rows, std::ostream& out) {
  std::vector<std::size_t> width(rows[0].size(), 0);
  for (const TableRow& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) width[k] = std::max(width[k], row[k].size());
  }
  for (const TableRow& row : rows) {
    std::string line = "   ";
    for (std::size_t k = 0; k < row.size(); ++k) {
      line += " " + row[k] + std::string(width[k] - row[k].size(), ' ') + " ";
    }
    out << line.substr(0, line.find_last_not_of(' ') + 1) << "\n";
  }
}

TableRow channel_row(const LogStream& stream, const LogChannel& channel, const ColumnRule& rule) {
  std::string unit = rule.unit.empty() ? si_unit_of(quantity_of_column(rule.to)) : rule.unit;
  if (unit.empty() || (rule.unit.empty() && rule.to.find(':') != rule.to.npos)) unit = "SI";
  if (rule.gain != 1.0) unit = number_text(rule.gain) + "*" + unit;
  if (rule.wrap != 0.0) unit += ", wraps at " + number_text(rule.wrap);
  return {excerpt(channel.name, 40),
          rule.to,
          unit,
          rule.why + (rule.assumed ? " ASSUMED" : ""),
          number_text(channel.low),
          number_text(channel.high),
          channel.finite == stream.rows ? "" : std::to_string(stream.rows - channel.finite)};
}

void describe_stream(const ForeignLog& log, const LogStream& stream, const Recipe& recipe,
                     std::ostream& out) {
  const ClockRule* clock = clock_for(recipe, stream);
  out << "  " << excerpt(stream.name, 80) << " (" << excerpt(stream.type, 60) << "), "
      << stream.rows << " rows";
  if (!stream.frame.empty()) out << ", frame " << excerpt(stream.frame, 40);
  if (!stream.child.empty()) out << ", child " << excerpt(stream.child, 40);
  out << "\n";
  if (clock != nullptr) out << "    " << clock_words(stream, *clock, log.file) << "\n";
  std::vector<TableRow> rows = {
      {"channel", "becomes", "unit", "known by", "smallest", "largest", "missing"}};
  std::string unused;
  std::size_t count = 0;
  for (const LogChannel& channel : stream.channels) {
    const ColumnRule* rule = rule_for(recipe, stream, channel.name);
    if (rule != nullptr) {
      rows.push_back(channel_row(stream, channel, *rule));
    } else if (clock == nullptr ||
               (channel.name != clock->channel && channel.name != clock->nanoseconds)) {
      if (++count <= kMostUnused)
        unused += (unused.empty() ? "" : ", ") + excerpt(channel.name, 40);
    }
  }
  if (rows.size() > 1) print_table(rows, out);
  if (count > kMostUnused) unused += " and " + std::to_string(count - kMostUnused) + " more";
  if (count > 0) out << "    not used: " << unused << "\n";
}

Json clock_figures_json(const LogStream& stream, const ClockRule& rule, const std::string& file) {
  if (rule.kind == "none") return nullptr;
  const ClockFigures f = clock_figures(clock_times(stream, rule, file));
  return {{"kind", rule.kind},
          {"unit", rule.unit},
          {"known_by", rule.why},
          {"assumed", rule.assumed},
          {"begin_s", f.begin},
          {"end_s", f.end},
          {"hz", f.step > 0.0 ? Json(1.0 / f.step) : Json()},
          {"gaps", f.gaps},
          {"repeats", f.repeats},
          {"backward", f.backward},
          {"share_irregular", f.off}};
}

}  // namespace

std::string describe(const ForeignLog& log, const Recipe& recipe) {
  std::ostringstream out;
  out << log.file << ": " << log.format << "\n";
  for (const LogStream& stream : log.streams) describe_stream(log, stream, recipe, out);
  if (recipe.columns.empty()) out << how_to_name(log) << "\n";
  return out.str();
}

Json describe_json(const ForeignLog& log, const Proposal& proposal) {
  Json streams = Json::array();
  for (const LogStream& stream : log.streams) {
    Json channels = Json::array();
    for (const LogChannel& channel : stream.channels) {
      const ColumnRule* rule = rule_for(proposal.recipe, stream, channel.name);
      Json row = {{"name", channel.name},
                  {"smallest", channel.finite > 0 ? Json(channel.low) : Json()},
                  {"largest", channel.finite > 0 ? Json(channel.high) : Json()},
                  {"missing", stream.rows - channel.finite}};
      row["becomes"] = rule != nullptr ? Json(rule->to) : Json();
      if (rule != nullptr) row["unit"] = rule->unit;
      if (rule != nullptr) row["unit_known_by"] = rule->why;
      channels.push_back(std::move(row));
    }
    Json entry = {{"name", stream.name}, {"type", stream.type}, {"rows", stream.rows}};
    const ClockRule* clock = clock_for(proposal.recipe, stream);
    entry["clock"] = clock != nullptr ? clock_figures_json(stream, *clock, log.file) : Json();
    entry["channels"] = std::move(channels);
    streams.push_back(std::move(entry));
  }
  Json json = {{"file", log.file}, {"format", log.format}, {"notes", log.notes}};
  json["streams"] = std::move(streams);
  json["questions"] = proposal.questions;
  json["guesses"] = proposal.guesses;
  json["recipe"] = to_json(proposal.recipe);
  return json;
}

Json axes_of(const Table& table, const Recipe& recipe) {
  const auto has = [&](const std::string& column) {
    return std::find(table.columns.begin(), table.columns.end(), column) != table.columns.end();
  };
  if (has("qw") || has("alpha")) return nullptr;
  Json axes = Json::array();
  for (const std::string& column : table.columns) {
    const std::string name = column.substr(std::min<std::size_t>(4, column.size()));
    if (!column.starts_with("tau_") || (!has("q_" + name) && !has("qd_" + name))) continue;
    bool slides = false;  // as any of its columns tells
    std::string electric;
    for (const ColumnRule& rule : recipe.columns) {
      const bool is_effort = rule.to == "tau:" + name;
      if (!is_effort && rule.to != "q:" + name && rule.to != "qd:" + name) continue;
      const auto unit = find_unit(rule.unit);
      if (!unit) continue;
      slides = slides || is_of_sliding_axis(rule.to, unit->quantity);
      if (is_effort && unit->quantity == std::string("voltage")) electric = "V";
      if (is_effort && unit->quantity == std::string("current")) electric = "A";
    }
    Json axis = {{"name", name},
                 {"measured", column},
                 {"unit", electric.empty() ? (slides ? "N" : "N*m") : electric},
                 {"base", Json::array()}};
    if (!electric.empty()) axis["position_unit"] = slides ? "m" : "rad";
    if (has("q_" + name)) axis["position"] = "q_" + name;
    if (has("qd_" + name)) axis["velocity"] = "qd_" + name;
    axes.push_back(std::move(axis));
  }
  if (axes.empty()) return nullptr;
  return {{"kind", "axes"}, {"axes", axes}};
}

}  // namespace dcnn
