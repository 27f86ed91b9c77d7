// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/claims.h"

#include <fcntl.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include "core/descriptor.h"
#include "core/replace.h"
#include "dcnn/core/ranks.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

struct Claims {
  std::mutex mutex;
  std::map<fs::path, bool (*)(const fs::path&)> files;
  std::set<fs::path> ours;
  std::vector<std::pair<fs::path, std::string>> patterns;  // of a folder
};

Claims& claims() {
  static Claims all;
  return all;
}

/// The same for every spelling of it.
fs::path one_name(const fs::path& path) {
  std::error_code error;
  const fs::path plain = fs::weakly_canonical(fs::absolute(path), error);
  return error ? path : plain;
}

}  // namespace

void claim_new(const fs::path& path, bool (*own)(const fs::path&)) {
  const Target target = target_of(path);
  if (target.descriptor >= 0) return;
  const std::lock_guard lock(claims().mutex);
  claims().files.insert_or_assign(one_name(target.file), own);
}

void claim_new(const fs::path& folder, const std::string& pattern) {
  const std::lock_guard lock(claims().mutex);
  claims().patterns.emplace_back(one_name(folder / "x").parent_path(), pattern);
}

bool must_be_new(const fs::path& file) {
  const std::lock_guard lock(claims().mutex);
  if (claims().files.empty() && claims().patterns.empty()) return false;
  const fs::path path = one_name(file);
  if (claims().ours.count(path) != 0) return false;
  if (const auto claim = claims().files.find(path); claim != claims().files.end()) {
    return claim->second == nullptr || !fs::exists(file) || !claim->second(file);
  }
  for (const auto& [folder, pattern] : claims().patterns) {
    if (folder == path.parent_path() &&
        ::fnmatch(pattern.c_str(), path.filename().c_str(), 0) == 0) {
      return true;
    }
  }
  return false;
}

void is_ours(const fs::path& file) {
  const std::lock_guard lock(claims().mutex);
  if (claims().files.empty() && claims().patterns.empty()) return;
  claims().ours.insert(one_name(file));
}

void expect_writable(const fs::path& folder) {
  std::error_code error;
  fs::path there = folder.empty() ? fs::path(".") : folder;
  while (!fs::exists(there, error) && there.has_parent_path() && there != there.parent_path()) {
    there = there.parent_path();
  }
  if (!fs::exists(there, error)) there = ".";
  if (!fs::is_directory(there, error)) return;  // whoever makes the folder says so
  const bool may = ::faccessat(AT_FDCWD, there.c_str(), W_OK | X_OK, AT_EACCESS) == 0;
  check_call(may, Exit::kFailure, there, "cannot write in this folder");
}

void sweep_temporaries(const fs::path& folder, const std::string& name) {
  using namespace std::chrono_literals;
  constexpr auto kInUse = 10min;
  std::error_code error;
  std::vector<fs::path> stale;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string found = entry.path().filename();
    if (!is_temporary_name(found) || found.compare(0, name.size(), name) != 0) continue;
    if (!entry.is_regular_file(error) || entry.is_symlink(error)) continue;
    const auto written = entry.last_write_time(error);
    if (!error && fs::file_time_type::clock::now() - written > kInUse) {
      stale.push_back(entry.path());
    }
  }
  for (const fs::path& file : stale) ::unlink(file.c_str());
}

NameLock::NameLock(const fs::path& path) {
  constexpr int kFlags = O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK;
  const Target target = target_of(path);
  if (!is_first_rank() || target.descriptor >= 0) return;
  make_folder(target.file.parent_path());
  name_ = target.file.string() + ".lock";
  const auto is_held = [&] {  // the one before removes its file: it may be another by now
    struct stat mine {
    }, named{};
    return ::fstat(file_, &mine) == 0 && ::stat(name_.c_str(), &named) == 0 &&
           mine.st_ino == named.st_ino && mine.st_dev == named.st_dev;
  };
  for (;;) {
    file_ = completed([&] { return ::open(name_.c_str(), kFlags, 0600); });
    check_call(file_ >= 0, Exit::kFailure, name_, "cannot write");
    const bool locked = completed([&] { return ::flock(file_, LOCK_EX | LOCK_NB); }) == 0;
    if (!locked && errno == EWOULDBLOCK) {
      ::close(std::exchange(file_, -1));
      fail(Exit::kUsage, path.string(),
           ": another process is writing this file; wait for it or name another");
    }
    if (!locked || is_held()) return;  // not every file system locks
    ::close(file_);
  }
}

NameLock::~NameLock() {
  if (file_ < 0) return;
  ::unlink(name_.c_str());
  ::close(file_);
}

}  // namespace dcnn
