// What kind of file a path names, so that a file given in another's place is called by its name.
#pragma once

#include <filesystem>
#include <initializer_list>

namespace dcnn {

enum class FileKind {
  kUnknown,  ///< nothing that the programs write or read; the reader says what is wrong with it
  kModel,
  kSimulator,
  kScene,
  kTruth,
  kSystem,
  kCalibration,
  kTeleop,
  kReport,
  kTraining,
  kRecording,
};

/// By its first bytes or its keys; kUnknown for what cannot be opened, too.
FileKind kind_of_file(const std::filesystem::path& file);

/// An error, with the exit code of a bad file of the first wanted kind, naming what `file` is where it is recognised as none of `wanted`. `place` is the
/// option that names it; an empty path passes.
void expect_kind(const std::string& place, const std::filesystem::path& file,
                 std::initializer_list<FileKind> wanted);

}  // namespace dcnn
