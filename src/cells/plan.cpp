// SPDX-License-Identifier: Apache-2.0
#include "dcnn/cells/plan.h"

#include <algorithm>

#include "cells/expand.h"
#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"
#include "dcnn/core/options.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostInputBytes = std::size_t{1} << 36;
constexpr std::size_t kMostPlanBytes = std::size_t{1} << 32;
constexpr const char* kPlanFile = "plan.jsonl";

/// Digests of the toolkit's programs that the cells name by their bare name.
void digest_programs(CellPlan& plan, const fs::path& folder, FileDigests& digests) {
  for (const Cell& cell : plan.cells) {
    for (const auto& command : cell.commands) {
      const std::string& program = command.front();
      if (program.find('/') != std::string::npos || plan.programs.contains(program)) continue;
      if (fs::is_regular_file(folder / program))
        plan.programs[program] = digests.of(folder / program);
    }
  }
}

std::string key_of(const Cell& cell, const CellPlan& plan) {
  Json identity = cell.to_json();
  for (const char* label : {"key", "name", "settings"}) identity.erase(label);
  Json programs = Json::object();
  for (const auto& command : cell.commands) {
    const auto found = plan.programs.find(command.front());
    if (found != plan.programs.end()) programs[found->first] = found->second;
  }
  identity["programs"] = programs;
  return sha256_hex({"dcnn cell 1\n", identity.dump()});
}

void order_cells(CellPlan& plan, const std::string& where) {
  auto& cells = plan.cells;
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.key < b.key; });
  std::map<std::string, const Cell*> names;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    require(i == 0 || cells[i].key != cells[i - 1].key, Exit::kUsage, where, ": the cells '",
            i == 0 ? "" : cells[i - 1].name, "' and '", cells[i].name,
            "' do the same; use every setting in commands or files, or leave it out");
    require(names.emplace(cells[i].name, &cells[i]).second, Exit::kUsage, where,
            ": two cells are called '", cells[i].name, "'; give a name with more settings in it");
  }
  plan.size = cells.size();
}

std::string shell_word(const std::string& word) {
  const char* tame = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  if (!word.empty() && word.find_first_not_of(tame) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

Json plan_header(const CellPlan& plan) {
  return {{"dcnn_plan", 1},          {"root", plan.root.string()},      {"cells", plan.size},
          {"threads", plan.threads}, {"programs", Json(plan.programs)}, {"columns", plan.columns}};
}

}  // namespace

const std::string& FileDigests::of(const fs::path& file) {
  std::string& digest = known_[file.string()];
  if (digest.empty()) digest = sha256_hex({read_file(file, kMostInputBytes, Exit::kData)});
  return digest;
}

Json Cell::to_json() const {
  Json lines = Json::array();
  for (const auto& command : commands) lines.push_back(command);
  Json json = {{"key", key}, {"name", name}, {"settings", settings}, {"commands", lines}};
  if (!files.empty()) json["files"] = files;
  if (!inputs.empty()) json["inputs"] = Json(inputs);
  json["keep"] = keep;
  json["drop"] = drop;
  if (timeout_s > 0.0) json["timeout_s"] = timeout_s;
  return json;
}

Cell Cell::from_json(const Json& json) {
  Cell cell;
  cell.key = json["key"].get<std::string>();
  cell.name = json["name"].get<std::string>();
  cell.settings = json["settings"];
  for (const Json& command : json["commands"]) {
    cell.commands.push_back(command.get<std::vector<std::string>>());
  }
  cell.files = json.value("files", cell.files);
  cell.inputs = json.value("inputs", cell.inputs);
  cell.keep = json["keep"].get<std::vector<std::string>>();
  cell.drop = json["drop"].get<std::vector<std::string>>();
  cell.timeout_s = json.value("timeout_s", 0.0);
  return cell;
}

std::string Cell::command_line() const {
  std::string line;
  for (const auto& command : commands) {
    if (!line.empty()) line += " &&";
    for (const std::string& word : command) line += (line.empty() ? "" : " ") + shell_word(word);
  }
  return line;
}

CellPlan make_plan(const Json& description, const std::string& where, const fs::path& root,
                   const fs::path& programs) {
  CellPlan plan;
  plan.root = fs::absolute(root).lexically_normal();
  Json cells = description;
  if (description.is_object()) {
    Options whole(description, where, Exit::kUsage);
    plan.threads = static_cast<int>(whole.number("threads", 1, 1, 1024));
    plan.columns = whole.raw("columns");
    if (plan.columns.is_null()) plan.columns = Json::object();
    for (const char* key : {"threads", "columns"}) cells.erase(key);
  }
  plan.cells = expand_cells(cells, where, plan.root);
  FileDigests digests;
  digest_programs(plan, programs, digests);
  for (Cell& cell : plan.cells) {
    for (auto& [file, digest] : cell.inputs) digest = digests.of(plan.root / file);
    cell.key = key_of(cell, plan);
  }
  order_cells(plan, where);
  return plan;
}

void write_plan(const CellPlan& plan, const fs::path& folder, bool replace) {
  std::string text = plan_header(plan).dump() + "\n";
  for (const Cell& cell : plan.cells) text += cell.to_json().dump() + "\n";
  const fs::path file = folder / kPlanFile;
  if (fs::exists(file)) {
    if (read_file(file, kMostPlanBytes, Exit::kUsage) == text) return;
    require(replace, Exit::kUsage, folder.string(),
            ": holds another plan, which is kept; name another folder, or replace the plan with "
            "--force: results of cells that both have stay");
  }
  write_file(file, text);
}

CellPlan read_plan(const fs::path& folder, Shard shard) {
  const fs::path file = folder / kPlanFile;
  require(fs::exists(file), Exit::kUsage, folder.string(),
          ": holds no plan; make one with dcnn-sweep SWEEP.json --plan ", folder.string());
  const std::string text = read_file(file, kMostPlanBytes, Exit::kUsage);
  CellPlan plan;
  std::int64_t number = -1;
  for (std::size_t at = 0; at < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line(text.data() + at, end - at);
    at = end + 1;
    if (number >= 0 && number % shard.count != shard.index - 1) continue;
    const Json json =
        parse_json(line, file.string() + ":" + std::to_string(number + 2), Exit::kUsage);
    try {
      if (number >= 0) {
        plan.cells.push_back(Cell::from_json(json));
        continue;
      }
      require(json["dcnn_plan"] == 1, Exit::kUsage, file.string(), ": not a plan of this version");
      plan.root = json["root"].get<std::string>();
      plan.size = json["cells"].get<std::size_t>();
      plan.threads = json["threads"];
      plan.programs = json["programs"].get<std::map<std::string, std::string>>();
      plan.columns = json["columns"];
    } catch (const Json::exception& error) {
      fail(Exit::kUsage, file.string(), ":", number + 2, ": not a line of a plan: ", error.what());
    }
  }
  require(number == static_cast<std::int64_t>(plan.size) && number > 0, Exit::kUsage, file.string(),
          ": the plan is not whole; make it again with --force");
  return plan;
}

}  // namespace dcnn
