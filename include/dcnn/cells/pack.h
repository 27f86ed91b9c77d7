// SPDX-License-Identifier: Apache-2.0
// Results of cells in files that only grow: one for each process that runs cells, any number of
// cells in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "dcnn/cells/plan.h"

namespace dcnn {

/// What a cell came to.
struct CellResult {
  std::string key;
  int exit = 0;                             ///< of the command that failed, else 0
  double seconds = 0.0, cpu_seconds = 0.0;  ///< wall, processor in user mode
  std::int64_t memory_kb = 0;               ///< largest resident set of its processes
  std::string log;                          ///< the end of its standard error
  std::vector<std::pair<std::string, std::string>> files;  ///< name, bytes; sorted by name
};

/// Appends to FOLDER/packs/<i>-of-<n>/<random>.pack, which it alone writes to and holds a lock on
/// (flock) while it lives. A record is a sealed line of JSON and the bytes of files: after a crash
/// at any moment it is whole or recognised as broken off.
class PackWriter {
 public:
  PackWriter(const std::filesystem::path& folder, Shard shard);
  ~PackWriter();
  PackWriter(const PackWriter&) = delete;
  PackWriter& operator=(const PackWriter&) = delete;

  /// For --status alone: not waited for until it is on the disk.
  void begin(const std::string& key);
  /// On the disk (fsync) when it returns. Error(kFailure) where the disk is full; what was
  /// appended before is kept.
  void append(const CellResult& result);

 private:
  void write(const std::string& bytes);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::int64_t size_ = 0;
};

/// Where a result lies, and all of it but the bytes of its files.
struct PackedResult {
  CellResult result;                                        ///< files without bytes
  std::vector<std::pair<std::string, std::int64_t>> sizes;  ///< name, bytes
  std::map<std::string, std::string> digests;               ///< name -> SHA-256
  std::filesystem::path pack;
  std::int64_t offset = 0;    ///< of the first file's bytes
  std::string digest;         ///< of exit code, names and bytes: the same wherever it was run
  bool contradicted = false;  ///< another run of the same cell gave other bytes
};

struct RunningCell {
  std::string key, host;
  double since = 0.0;  ///< s since 1970
};

struct PackIndex {
  std::map<std::string, PackedResult> results;  ///< by key
  std::vector<RunningCell> running;  ///< begun by a process that holds its pack, not finished
  std::vector<std::string> broken;   ///< packs and what is wrong with them, one line each
};

/// Results of the cells whose key is `wanted`, verified byte by byte. Of several for one cell the
/// one without failure is taken, then that of the least digest: the choice does not depend on who
/// was first.
PackIndex read_packs(const std::filesystem::path& folder,
                     const std::function<bool(const std::string& key)>& wanted);

/// The bytes of a result's files, verified again.
CellResult read_result(const PackedResult& packed);

}  // namespace dcnn
