// SPDX-License-Identifier: Apache-2.0
#include "dcnn/import/assemble.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "data/clock.h"
#include "data/text.h"
#include "dcnn/core/error.h"
#include "import/clocks.h"
#include "import/roles.h"
#include "import/stream_table.h"

namespace dcnn {
namespace {

/// The recording's order of columns; others follow as they come.
Table in_order(const StreamTable& from) {
  const std::vector<std::string> first = {"x",    "y",     "z",  "qw", "qx", "qy", "qz", "alpha",
                                          "beta", "gamma", "fx", "fy", "fz", "tx", "ty", "tz"};
  std::vector<Index> order;
  for (const std::string& column : first) {
    if (from.has(column)) order.push_back(from.find(column));
  }
  for (std::size_t k = 0; k < from.columns.size(); ++k) {
    if (std::find(first.begin(), first.end(), from.columns[k]) == first.end()) {
      order.push_back(static_cast<Index>(k));
    }
  }
  Table table;
  const Index shift = from.t.empty() ? 0 : 1;
  table.values.resize(from.values.rows(), static_cast<Index>(order.size()) + shift);
  if (shift == 1) {
    table.columns.emplace_back("t");
    table.values.col(0) =
        Eigen::Map<const Eigen::VectorXd>(from.t.data(), static_cast<Index>(from.t.size()));
  }
  for (std::size_t k = 0; k < order.size(); ++k) {
    table.columns.push_back(from.columns[static_cast<std::size_t>(order[k])]);
    table.values.col(static_cast<Index>(k) + shift) = from.values.col(order[k]);
  }
  return table;
}

/// What the sensor read before the controller took a payload's weight off.
void add_payload(const Payload& payload, const std::string& file, Imported* imported) {
  if (payload.mass == 0.0) return;
  Recording recording;
  recording.table = std::move(imported->table);
  recording.segments = {{0, recording.samples()}};
  require(recording.has_all(kQuaternion) || recording.has_all(kEuler), Exit::kData, file,
          ": a payload's weight needs an orientation to be added back by");
  add_weight(payload, recording);
  imported->table = std::move(recording.table);
  imported->notes.insert(imported->notes.end(), recording.notes.begin(), recording.notes.end());
}

/// Columns of joints: "q:elbow" is q_elbow.
void name_joints(Table* table) {
  for (std::string& column : table->columns) std::replace(column.begin(), column.end(), ':', '_');
}

void put_on_regular_clock(double hz, const std::string& file, Imported* imported) {
  Recording recording;
  recording.table = std::move(imported->table);
  const double origin = recording.table.values(0, 0);
  set_clock(recording, file, false);
  resample(recording, hz, {"x", "y", "z", "alpha", "beta", "gamma", "qw", "qx", "qy", "qz"});
  if (recording.clock_origin != 0.0) {
    recording.set("t", recording.column("t").array() + origin);
  }
  imported->table = std::move(recording.table);
  imported->notes.insert(imported->notes.end(), recording.notes.begin(), recording.notes.end());
}

void check_columns(const ForeignLog& log, const Recipe& recipe) {
  require(!recipe.columns.empty(), Exit::kData, log.file, ": ", how_to_name(log),
          "; --dry-run lists the channels");
  for (std::size_t a = 0; a < recipe.columns.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      require(recipe.columns[a].to != recipe.columns[b].to, Exit::kData, log.file, ": column ",
              shown(recipe.columns[a].to), " is there twice in the recipe");
    }
  }
}

}  // namespace

Imported assemble(const ForeignLog& log, const Recipe& recipe) {
  check_columns(log, recipe);
  Imported imported;
  std::vector<StreamTable> tables;
  for (const ClockRule& clock : recipe.clocks) {
    std::vector<StreamTable> parts = make_stream_tables(log, recipe, clock, &imported.notes);
    for (StreamTable& part : parts) convert_orientation(recipe, &part, log.file);
    const auto place = clock.stream == recipe.clock ? tables.begin() : tables.end();
    tables.insert(place, std::make_move_iterator(parts.begin()),
                  std::make_move_iterator(parts.end()));
  }
  StreamTable joined = join_streams(std::move(tables), &imported.notes);
  turn_wrench(recipe.wrench, &joined, log.file);
  imported.table = in_order(joined);
  add_payload(recipe.wrench.payload, log.file, &imported);
  name_joints(&imported.table);
  if (recipe.resample_hz != 0.0 && !joined.t.empty()) {
    put_on_regular_clock(std::max(0.0, recipe.resample_hz), log.file, &imported);
  }
  return imported;
}

bool holds(const ForeignLog& log, const Recipe& recipe) {
  return std::all_of(log.streams.begin(), log.streams.end(), [&](const LogStream& stream) {
    return std::all_of(stream.channels.begin(), stream.channels.end(),
                       [&](const LogChannel& channel) {
                         return !recipe.names(stream, channel.name) ||
                                static_cast<Index>(channel.values.size()) == stream.rows;
                       });
  });
}

std::vector<std::filesystem::path> split_paths(const std::filesystem::path& path) {
  if (std::filesystem::exists(path)) return {path};
  std::vector<std::filesystem::path> paths;
  std::istringstream words(path.string());
  for (std::string word; std::getline(words, word, '+');) paths.emplace_back(word);
  return paths;
}

Imported import_recording(const std::filesystem::path& path, const Recipe& recipe,
                          const ReadLogOptions& options) {
  const auto paths = split_paths(path);
  require(static_cast<int>(paths.size()) == recipe.files, Exit::kUsage, path.string(), ": ",
          paths.size(), " files, and the recipe is of ", recipe.files,
          recipe.files > 1 ? "; join their names by '+'" : "");
  ReadLogOptions read = options;
  read.text = recipe.text;
  read.wanted = [&recipe](const LogStream& stream, const std::string& channel) {
    return recipe.names(stream, channel);
  };
  const ForeignLog log = read_log(paths, read);
  Imported imported = assemble(log, recipe);
  imported.notes.insert(imported.notes.begin(), log.notes.begin(), log.notes.end());
  return imported;
}

}  // namespace dcnn
