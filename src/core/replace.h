// SPDX-License-Identifier: Apache-2.0
// How files come to their names: bytes on the disk under a name of their own, then rename.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string_view>
#include <vector>

#include "dcnn/core/error.h"

namespace dcnn {

/// Fails with errno's words unless `ok`: read here, after the call, which an argument of require()
/// may come before.
void check_call(bool ok, Exit exit, const std::filesystem::path& path, const char* what);

/// What a path to a folder names: where it is a link to nothing, the folder that the link asks for.
std::filesystem::path real_folder(const std::filesystem::path& folder);
/// Makes it and its parents; nothing for an empty path.
void make_folder(const std::filesystem::path& folder);
/// Those of a folder and its parents that are not there, the innermost first.
std::vector<std::filesystem::path> missing_folders(const std::filesystem::path& folder);

/// A name in the folder lasts only once the folder is on the disk. Not every file system can, and
/// not every folder may be read.
void sync_folder(const std::filesystem::path& folder);
std::filesystem::path folder_of(const std::filesystem::path& path);

/// Where bytes for a path go: into an open descriptor, or into what the path's last link names.
struct Target {
  int descriptor = -1;
  std::filesystem::path file;
};
Target target_of(std::filesystem::path path);

/// A name beside `path` that nobody can have foreseen or linked elsewhere: PATH.tmp<digits>.
std::filesystem::path temporary_name(const std::filesystem::path& path);
bool is_temporary_name(const std::string& name);

/// Makes the file `name`, which nothing may have, with these bytes on the disk and the mode of
/// `path`, whose name errors have; a failure leaves no file. False where `name` is taken.
bool write_aside(const std::filesystem::path& name, std::string_view bytes,
                 const std::filesystem::path& path);

/// rename() that replaces nothing: false with EEXIST where `to` is there.
bool rename_new(const std::filesystem::path& from, const std::filesystem::path& to);

/// Whether claim_new() holds for this file (as target_of() names it), and that it is ours now.
bool must_be_new(const std::filesystem::path& file);
void is_ours(const std::filesystem::path& file);

}  // namespace dcnn
