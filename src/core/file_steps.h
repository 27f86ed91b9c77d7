// SPDX-License-Identifier: Apache-2.0
// The names that a set of files changes, one after the other, and the way back.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/error.h"

namespace dcnn {

/// One name. What has been done is seen from the files themselves: `staged` is there until it has
/// become `to`, and `old` is what `to` was.
struct FileStep {
  enum class Kind : char { kReplace = 'r', kNew = 'n', kRemove = 'd' };
  Kind kind = Kind::kReplace;
  std::filesystem::path to, staged, old;
  int number = 0;        ///< staging/NUMBER and staging/NUMBER.old, where it is inside the folder
  bool outside = false;  ///< of the folder: staged and kept beside `to`
};

/// A folder of staged files in the folder of the set.
struct Staging {
  std::filesystem::path folder, path;

  FileStep step(FileStep::Kind kind, const std::filesystem::path& to, int number) const;
  std::filesystem::path journal() const { return path / "journal"; }
  /// Again where it fails at first; what stays after all is harmless and goes with the next set.
  void remove() const;
};

/// All steps, those outside first; where one fails all the way back, and Error(kFailure). Nothing
/// is lost where the way back fails as well: the journal stays.
void carry_out(const std::vector<FileStep>& steps, const Staging& staging);

/// The journal of these steps, and what it says; nothing where it is not whole.
std::string journal_text(const std::vector<FileStep>& steps, const Staging& staging);

/// Finishes or undoes the steps of a journal and removes the folder of staged files. A journal may
/// be anybody's: nothing outside the folder is touched.
void recover(const Staging& staging);

}  // namespace dcnn
