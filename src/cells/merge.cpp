// SPDX-License-Identifier: Apache-2.0
#include "dcnn/cells/merge.h"

#include <fstream>
#include <set>

#include "dcnn/cells/pack.h"
#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "{\"dcnn_cells\":";  // how a table begins

PackIndex packs_of(const fs::path& folder, const CellPlan& plan) {
  std::set<std::string> keys;
  for (const Cell& cell : plan.cells) keys.insert(cell.key);
  return read_packs(folder, [&](const std::string& key) { return keys.contains(key); });
}

std::string last_line(const std::string& log) {
  const std::size_t end = log.find_last_not_of('\n');
  if (end == std::string::npos) return "no words";
  const std::size_t begin = log.find_last_of('\n', end);
  return log.substr(begin == std::string::npos ? 0 : begin + 1,
                    end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

/// The value of a JSON pointer (RFC 6901) without its escapes; null where there is none.
Json pointed_at(const Json& document, const std::string& pointer) {
  const Json* at = &document;
  for (std::size_t from = 0; from < pointer.size() && at;) {
    const std::size_t end = std::min(pointer.find('/', from + 1), pointer.size());
    const std::string word = pointer.substr(from + 1, end - from - 1);
    from = end;
    if (at->is_array()) {
      const bool number =
          !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
      const std::size_t index = number && word.size() < 10 ? std::stoul(word) : at->size();
      at = index < at->size() ? &at->at(index) : nullptr;
    } else {
      at = at->is_object() ? at->find(word) : nullptr;
    }
  }
  return at ? *at : Json();
}

/// The columns of one cell: "evaluation.json#/summary/0/rmse", null where its file lacks it.
void add_columns(const Json& columns, const PackedResult& packed, Json& row) {
  if (columns.empty()) return;
  const CellResult result = packed.result.exit == 0 ? read_result(packed) : CellResult();
  std::map<std::string, Json> documents;
  for (const auto& [name, bytes] : result.files) {
    for (const auto& column : columns.items()) {
      if (column.second.get<std::string>().starts_with(name + "#")) {
        documents[name] =
            parse_json(bytes, row["name"].get<std::string>() + "/" + name, Exit::kData);
        break;
      }
    }
  }
  for (const auto& [name, column] : columns.items()) {
    const auto place = column.get<std::string>();
    const std::size_t hash = place.find('#');
    const auto document = documents.find(place.substr(0, hash));
    row[name] =
        document == documents.end() ? Json() : pointed_at(document->second, place.substr(hash + 1));
  }
}

Json table_row(const CellPlan& plan, const Cell& cell, const PackedResult& packed) {
  Json row = {{"name", cell.name}, {"key", cell.key}};
  if (!cell.settings.empty()) row["settings"] = cell.settings;
  row["exit"] = packed.result.exit;
  add_columns(plan.columns, packed, row);
  row["sha256"] = Json(packed.digests);
  return row;
}

std::string failure_line(const Cell& cell, const CellResult& result) {
  return cell.name + ": exit " + std::to_string(result.exit) + ": " + cell.command_line() + ": " +
         last_line(result.log);
}

/// True where the file has these bytes already.
bool is_same(const fs::path& file, const std::string& bytes) {
  std::error_code error;
  return fs::file_size(file, error) == bytes.size() && !error &&
         read_file(file, bytes.size(), Exit::kFailure) == bytes;
}

void unpack_file(const fs::path& file, const std::string& bytes, bool replace) {
  if (is_same(file, bytes)) return;
  // What is there now may have been put there since by another merge, whole.
  const bool other = !replace && fs::exists(file) && !is_same(file, bytes);
  require(!other, Exit::kUsage, file.string(),
          ": holds another result, which is kept; name another folder, or replace it with --force");
  write_file(file, bytes);
}

}  // namespace

MergedCells merge_cells(const fs::path& folder) {
  const CellPlan plan = read_plan(folder);
  const PackIndex index = packs_of(folder, plan);
  MergedCells merged;
  merged.warnings = index.broken;
  std::string keys;
  for (const Cell& cell : plan.cells) {
    keys += cell.key;
    const auto found = index.results.find(cell.key);
    if (found == index.results.end()) {
      merged.missing.push_back(cell.name);
      continue;
    }
    const PackedResult& packed = found->second;
    if (packed.result.exit != 0) merged.failed.push_back(failure_line(cell, packed.result));
    if (packed.contradicted) {
      merged.warnings.push_back(cell.name +
                                ": two runs gave different bytes: " + cell.command_line() +
                                " depends on something that the plan does not name");
    }
    merged.table += table_row(plan, cell, packed).dump() + "\n";
  }
  merged.table = Json({{"dcnn_cells", plan.cells.size()}, {"plan", sha256_hex({keys})}}).dump() +
                 "\n" + merged.table;
  return merged;
}

bool is_merged_table(const fs::path& file) {
  std::string begin(std::string_view(kMark).size(), '\0');
  std::ifstream in(file, std::ios::binary);
  return in.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == kMark;
}

void unpack_cells(const fs::path& folder, const fs::path& into, bool replace) {
  const CellPlan plan = read_plan(folder);
  const PackIndex index = packs_of(folder, plan);
  for (const Cell& cell : plan.cells) {
    const auto found = index.results.find(cell.key);
    if (found == index.results.end()) continue;
    const CellResult result = read_result(found->second);
    const fs::path place = into / cell.name;
    for (const auto& [name, bytes] : result.files) unpack_file(place / name, bytes, replace);
    const Json times = {
        {"exit", result.exit}, {"seconds", result.seconds}, {"cpu_seconds", result.cpu_seconds}};
    // A cell that was run twice has two times: those of the result that was taken.
    unpack_file(place / "run.json", times.dump() + "\n", true);
    if (!result.log.empty()) unpack_file(place / "stderr", result.log, true);
  }
}

Json cells_status(const fs::path& folder) {
  const CellPlan plan = read_plan(folder);
  const PackIndex index = packs_of(folder, plan);
  std::map<std::string, std::string> name_of;
  Json failed = Json::array();
  std::size_t done = 0, running = 0;
  double seconds = 0.0, longest = 0.0;
  std::int64_t memory_kb = 0;
  for (const Cell& cell : plan.cells) {
    name_of[cell.key] = cell.name;
    const auto found = index.results.find(cell.key);
    if (found == index.results.end()) continue;
    const CellResult& result = found->second.result;
    seconds += result.seconds;
    longest = std::max(longest, result.seconds);
    memory_kb = std::max(memory_kb, result.memory_kb);
    if (result.exit == 0) {
      ++done;
    } else {
      failed.push_back({{"name", cell.name},
                        {"exit", result.exit},
                        {"command", cell.command_line()},
                        {"log", result.log}});
    }
  }
  Json at_work = Json::array();
  for (const RunningCell& cell : index.running) {
    if (index.results.contains(cell.key)) continue;
    at_work.push_back({{"name", name_of[cell.key]}, {"host", cell.host}, {"since", cell.since}});
    ++running;
  }
  const std::size_t ended = done + failed.size(), left = plan.cells.size() - ended;
  const Json mean = ended == 0 ? Json() : Json(seconds / static_cast<double>(ended));
  const Json eta =
      ended == 0 || running == 0
          ? Json()
          : Json(mean.get<double>() * static_cast<double>(left) / static_cast<double>(running));
  return {{"cells", plan.cells.size()}, {"done", done},           {"failed", failed},
          {"running", at_work},         {"left", left},           {"mean_s", mean},
          {"longest_s", longest},       {"memory_kb", memory_kb}, {"eta_s", eta},
          {"broken", index.broken}};
}

}  // namespace dcnn
