// SPDX-License-Identifier: Apache-2.0
#include "core/replace.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "core/descriptor.h"

namespace dcnn {

namespace fs = std::filesystem;

void check_call(bool ok, Exit exit, const fs::path& path, const char* what) {
  if (!ok) fail(exit, path.string(), ": ", what, ": ", std::strerror(errno));
}

fs::path real_folder(const fs::path& folder) {
  const fs::path plain = folder.has_filename() ? folder : folder.parent_path();
  std::error_code error;
  const bool dangles = fs::is_symlink(plain, error) && !fs::exists(plain, error);
  return dangles ? target_of(plain).file : plain;
}

std::vector<fs::path> missing_folders(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path at = real_folder(folder);
       !at.empty() && !fs::exists(fs::symlink_status(at, error)) && at != at.parent_path();
       at = at.parent_path()) {
    missing.push_back(at);
  }
  return missing;
}

void make_folder(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  fs::create_directories(real_folder(folder), error);
  require(!error, Exit::kFailure, folder.string(), ": cannot make this folder: ", error.message());
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

void sync_folder(const fs::path& folder) {
  Descriptor fd(
      completed([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }));
  if (fd.get() < 0) return;
  const bool done = completed([&] { return ::fsync(fd.get()); }) == 0;
  check_call(done || errno == EINVAL || errno == ENOTSUP, Exit::kFailure, folder, "cannot write");
}

namespace {

/// The number of an open descriptor that a path such as /dev/fd/1 names, -1 for other paths.
int named_descriptor(const fs::path& path) {
  if (path == "-") return STDOUT_FILENO;
  const fs::path folder = path.parent_path();
  if (folder != "/proc/self/fd" && folder != "/dev/fd") return -1;
  const std::string name = path.filename();
  int number = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc() && end == name.data() + name.size() ? number : -1;
}

constexpr std::string_view kTemporary = ".tmp";

}  // namespace

Target target_of(fs::path path) {
  constexpr int kMostLinks = 40;  // Linux follows as many
  for (int links = 0; links <= kMostLinks; ++links) {
    if (const int descriptor = named_descriptor(path); descriptor >= 0) return {descriptor, {}};
    std::error_code error;
    const fs::path next = fs::read_symlink(path, error);
    if (error) return {-1, path};
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  fail(Exit::kFailure, path.string(), ": too many links");
}

fs::path temporary_name(const fs::path& path) {
  std::uint64_t word = 0;
  const bool drawn = ::getentropy(&word, sizeof word) == 0;
  check_call(drawn, Exit::kFailure, path, "cannot write");
  char digits[21];  // a user's own x.tmp1 is no temporary of ours: those have 20 digits
  std::snprintf(digits, sizeof digits, "%020llu", static_cast<unsigned long long>(word));
  return path.string() + std::string(kTemporary) + digits;
}

bool is_temporary_name(const std::string& name) {
  constexpr std::size_t kFewest = 16;  // earlier versions wrote no leading zeros
  const auto at = name.rfind(kTemporary);
  if (at == std::string::npos || at == 0) return false;
  const std::string_view digits = std::string_view(name).substr(at + kTemporary.size());
  return digits.size() >= kFewest && digits.find_first_not_of("0123456789") == digits.npos;
}

bool write_aside(const fs::path& name, std::string_view bytes, const fs::path& path) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  struct stat old {};
  const mode_t mode = ::stat(path.c_str(), &old) == 0 ? old.st_mode & 0777 : 0644;
  Descriptor fd(completed([&] { return ::open(name.c_str(), kFlags, mode); }));
  if (fd.get() < 0 && errno == EEXIST) return false;
  check_call(fd.get() >= 0, Exit::kFailure, path, "cannot write");
  try {
    const bool written = write_all(fd.get(), bytes);
    check_call(written, Exit::kFailure, path, "cannot write");
    const bool synced = completed([&] { return ::fsync(fd.get()); }) == 0;
    check_call(synced, Exit::kFailure, path, "cannot write");
  } catch (const Error&) {
    ::unlink(name.c_str());
    throw;
  }
  return true;
}

bool rename_new(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;  // not every file system has it
  if (::link(from.c_str(), to.c_str()) != 0) return false;
  ::unlink(from.c_str());
  return true;
}

}  // namespace dcnn
