// SPDX-License-Identifier: Apache-2.0
// Long work cut into cells: commands whose results depend on nothing but their declared inputs, so
// that any engine may run them, in any order, and finished ones are never run again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn {

/// Commands run one after the other in a folder of their own, in which `in` is the plan's root and
/// `out` takes what they write.
struct Cell {
  std::string key;   ///< SHA-256 of programs, commands, files, inputs, what is kept and the limit
  std::string name;  ///< unique in the plan; a folder where results are unpacked
  Json settings = Json::object();  ///< what it differs from others by, for the table
  std::vector<std::vector<std::string>> commands;
  Json files = Json::object();                ///< JSON documents that are written before it runs
  std::map<std::string, std::string> inputs;  ///< file below the root -> SHA-256
  std::vector<std::string> keep{"*"}, drop;   ///< names of results, with * and ?
  double timeout_s = 0.0;                     ///< of all its commands together; 0: none

  Json to_json() const;
  static Cell from_json(const Json& json);
  /// Its commands as a shell would take them.
  std::string command_line() const;
};

struct CellPlan {
  std::filesystem::path root;                   ///< what `in` is
  int threads = 1;                              ///< of each cell (OMP_NUM_THREADS)
  std::map<std::string, std::string> programs;  ///< of the toolkit -> SHA-256
  Json columns = Json::object();                ///< column of the table -> "file.json#/pointer"
  std::vector<Cell> cells;                      ///< in the order of their keys
  std::size_t size = 0;                         ///< cells of the whole plan, of all shards
};

/// Share number `index` (from 1) of `count`: every count-th cell. Keys are random numbers, so
/// shares of equal size take about equally long.
struct Shard {
  std::int64_t index = 1, count = 1;
};

/// Cells from a description: "commands", "grid", "list", "name", "files", "inputs", "keep", "drop",
/// "columns", "timeout_s", "threads" (docs/use/cluster.md), or "cells", a list of such objects
/// without grids. Inputs lie below `root`; `programs` is the folder of the toolkit's.
CellPlan make_plan(const Json& description, const std::string& where,
                   const std::filesystem::path& root, const std::filesystem::path& programs);

/// FOLDER/plan.jsonl. Error(kUsage) where another plan is there, unless `replace`; results stay.
void write_plan(const CellPlan& plan, const std::filesystem::path& folder, bool replace);
CellPlan read_plan(const std::filesystem::path& folder, Shard shard = {});

/// SHA-256 of files and of the toolkit's programs, each read once.
class FileDigests {
 public:
  const std::string& of(const std::filesystem::path& file);

 private:
  std::map<std::string, std::string> known_;
};

}  // namespace dcnn
