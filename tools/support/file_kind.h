// SPDX-License-Identifier: Apache-2.0
// What kind of file a path names, so that a file given in another's place is called by its name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dcnn {

enum class FileKind {
  kUnknown,  ///< nothing that the programs write or read; the reader says what is wrong with it
  kJson,     ///< JSON that is none of the others
  kModel,
  kSimulator,
  kMachine,
  kScene,
  kTruth,
  kSystem,
  kCalibration,
  kTeleop,
  kReport,
  kTraining,
  kLimits,
  kRecipe,
  kSweep,
  kRecording,
};

/// By its first bytes or its keys; kUnknown for what cannot be opened, too.
FileKind kind_of_file(const std::filesystem::path& file);

/// An error, with the exit code of a bad file of the first wanted kind, naming what `file` is where
/// it is recognised as none of `wanted`, and where those come from. `place` is the option that
/// names it.
void expect_kind(const std::string& place, const std::filesystem::path& file,
                 const std::vector<FileKind>& wanted);

/// The same for a file that is missing, or a folder. Recordings and standard input pass: who reads
/// them knows more of these.
void expect_file(const std::string& place, const std::filesystem::path& file,
                 const std::vector<FileKind>& wanted);

}  // namespace dcnn
