// SPDX-License-Identifier: Apache-2.0
// Several files as one: all new or all as they were, whatever fails and whenever the process ends.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "dcnn/core/error.h"

namespace dcnn {

/// While it lives, write_file() puts its bytes aside (on the disk, in FOLDER/.dcnn-set-…) and
/// read_file() of the same name reads them; commit() gives all of them their names. What fails
/// before or within commit() leaves every file as it was; a process that ends within it leaves a
/// journal, by which the next FileSet or FolderLock of the folder finishes or undoes the set. One
/// set at a time: a set within another one is part of that.
class FileSet {
 public:
  explicit FileSet(const std::filesystem::path& folder);
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  /// Files of an earlier result go with commit(): those below the folder whose path matches
  /// `pattern` (*, ? and [ ] within a name) and which this set does not write.
  void replaces(const std::string& pattern);
  void commit();

  class State;

 private:
  std::unique_ptr<State> state_;  ///< none within another set
};

/// Finishes, or undoes, the sets of ended processes in this folder. Error(kFailure) where neither
/// can be done.
void recover_file_sets(const std::filesystem::path& folder);

}  // namespace dcnn
