// SPDX-License-Identifier: Apache-2.0
// Names that a command keeps for itself from its first look at them until it has written.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "dcnn/core/error.h"

namespace dcnn {

/// Nothing was at `path`: the first write_file() of it makes a file and replaces none that somebody
/// else has made since, but those of which `own` says that they may be.
void claim_new(const std::filesystem::path& path,
               bool (*own)(const std::filesystem::path&) = nullptr);
/// The same for all files of a folder whose names match `pattern` (with *, ? and [ ]).
void claim_new(const std::filesystem::path& folder, const std::string& pattern);

/// Throws Error(kFailure) where files can be neither made nor replaced in this folder, or in the
/// nearest one above that exists.
void expect_writable(const std::filesystem::path& folder);

/// Removes temporary files of ended processes: of the folder, or of its file `name` alone. Those
/// written to in the last ten minutes may be another process's and stay.
void sweep_temporaries(const std::filesystem::path& folder, const std::string& name = {});

/// The name of one file, for this process alone: flock() on NAME.lock, which goes with it. Throws
/// Error(kUsage) where another process holds it.
class NameLock {
 public:
  explicit NameLock(const std::filesystem::path& path);
  ~NameLock();
  NameLock(NameLock&& other) noexcept
      : name_(std::move(other.name_)), file_(std::exchange(other.file_, -1)) {}
  NameLock& operator=(NameLock&&) = delete;

 private:
  std::filesystem::path name_;
  int file_ = -1;
};

}  // namespace dcnn
