// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/file_set.h"

#include <fcntl.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>

#include "core/descriptor.h"
#include "core/file_steps.h"
#include "core/replace.h"
#include "core/staging.h"
#include "dcnn/core/ranks.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;
using Kind = FileStep::Kind;

constexpr std::string_view kStaging = ".dcnn-set-";

/// flock() on a folder of staged files, as long as its process lives; -1 where another holds it or
/// it is gone.
int lock_staging(const fs::path& path) {
  const int fd = completed(
      [&] { return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC); });
  if (fd < 0) return -1;
  struct stat mine {
  }, named{};
  const bool locked = completed([&] { return ::flock(fd, LOCK_EX | LOCK_NB); }) == 0;
  const bool is_it = ::fstat(fd, &mine) == 0 && ::lstat(path.c_str(), &named) == 0 &&
                     mine.st_ino == named.st_ino && mine.st_uid == ::geteuid();
  if (locked && is_it) return fd;
  ::close(fd);
  return -1;
}

/// Regular files below `folder` whose path matches.
void add_matching(const fs::path& folder, const fs::path& pattern, std::vector<fs::path>& found) {
  const fs::path first = *pattern.begin();
  const fs::path rest = pattern.lexically_relative(first);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (::fnmatch(first.c_str(), entry.path().filename().c_str(), FNM_PERIOD) != 0) continue;
    const auto kind = entry.symlink_status(error).type();
    if (rest == "." && kind == fs::file_type::regular) found.push_back(entry.path());
    if (rest != "." && kind == fs::file_type::directory) add_matching(entry.path(), rest, found);
  }
}

}  // namespace

class FileSet::State {
 public:
  explicit State(fs::path folder) : folder_(folder.empty() ? "." : std::move(folder)) {}

  ~State() {
    for (const FileStep& step : steps_) {
      if (step.outside && !unfinished_) ::unlink(step.staged.c_str());
    }
    if (!unfinished_ && !staging_.path.empty()) staging_.remove();
    if (lock_ >= 0) ::close(lock_);
  }

  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void put(const fs::path& file, std::string_view bytes) {
    const fs::path to = one_name(file);
    const std::lock_guard lock(mutex_);
    begin();
    require(!fs::is_directory(to), Exit::kFailure, file.string(),
            ": cannot replace: ", std::strerror(EISDIR));
    if (const auto before = places_.find(to); before != places_.end()) {
      ::unlink(steps_[before->second].staged.c_str());
      write_aside(steps_[before->second].staged, bytes, file);
      return;
    }
    FileStep step = staging_.step(must_be_new(file) ? Kind::kNew : Kind::kReplace, to, next_++);
    const fs::path inside = to.lexically_relative(staging_.folder);
    step.outside = inside.empty() || *inside.begin() == "..";
    if (step.outside) {  // perhaps on another file system
      step.staged = temporary_name(to);
      step.old = temporary_name(to);
    }
    const bool made = write_aside(step.staged, bytes, file);
    require(made, Exit::kFailure, step.staged.string(), ": cannot write: ", std::strerror(EEXIST));
    places_[to] = steps_.size();
    steps_.push_back(step);
  }

  std::optional<fs::path> staged(const fs::path& file) {
    const std::lock_guard lock(mutex_);
    const auto place = places_.find(one_name(file));
    if (place == places_.end()) return std::nullopt;
    return steps_[place->second].staged;
  }

  void replaces(const std::string& pattern) { patterns_.push_back(pattern); }

  void commit() {
    const std::lock_guard lock(mutex_);
    if (steps_.empty()) return;
    add_removals();
    std::stable_partition(steps_.begin(), steps_.end(), [](const auto& s) { return s.outside; });
    write_aside(staging_.journal(), journal_text(steps_, staging_), staging_.journal());
    sync_folder(staging_.path);
    unfinished_ = true;  // until all is done, or undone
    try {
      carry_out(steps_, staging_);
    } catch (const Error& error) {
      unfinished_ = std::any_of(steps_.begin(), steps_.end(), [](const FileStep& step) {
        return step.kind != Kind::kRemove && !fs::exists(fs::symlink_status(step.staged));
      });
      throw;
    }
    unfinished_ = false;
    for (const FileStep& step : steps_) {
      is_ours(step.to);
      const fs::path folder = step.to.parent_path();
      if (step.kind == Kind::kRemove && folder != staging_.folder) ::rmdir(folder.c_str());
    }
  }

 private:
  /// Before the first file: a set of streams alone needs no folder.
  void begin() {
    if (!staging_.path.empty()) return;
    make_folder(folder_);
    staging_.folder = fs::canonical(folder_);
    recover_file_sets(staging_.folder);
    make_staging();
  }

  void make_staging() {
    constexpr int kTries = 10;
    for (int i = 0; i < kTries && lock_ < 0; ++i) {
      const std::string digits = temporary_name("").string().substr(4);
      staging_.path = staging_.folder / (std::string(kStaging) + digits);
      const bool made = completed([&] { return ::mkdir(staging_.path.c_str(), 0700); }) == 0;
      if (!made && errno == EEXIST) continue;
      check_call(made, Exit::kFailure, staging_.folder, "cannot write in this folder");
      lock_ = lock_staging(staging_.path);
      if (lock_ < 0 && fs::exists(staging_.path)) return;  // a file system without locks
    }
  }

  static fs::path one_name(const fs::path& file) {
    std::error_code error;
    const fs::path folder = fs::weakly_canonical(folder_of(file), error);
    return error ? file : folder / file.filename();
  }

  void add_removals() {
    std::vector<fs::path> earlier;
    for (const std::string& pattern : patterns_) add_matching(staging_.folder, pattern, earlier);
    for (const fs::path& file : earlier) {
      if (places_.emplace(file, steps_.size()).second) {
        steps_.push_back(staging_.step(Kind::kRemove, file, next_++));
      }
    }
  }

  const fs::path folder_;
  std::mutex mutex_;
  Staging staging_;
  int lock_ = -1, next_ = 0;
  std::vector<FileStep> steps_;
  std::map<fs::path, std::size_t> places_;  // in steps_
  std::vector<std::string> patterns_;
  bool unfinished_ = false;
};

namespace {

FileSet::State* living = nullptr;

}  // namespace

FileSet::FileSet(const fs::path& folder) {
  if (living != nullptr || !is_first_rank()) return;
  state_ = std::make_unique<State>(folder);
  living = state_.get();
}

FileSet::~FileSet() {
  if (state_ != nullptr && living == state_.get()) living = nullptr;
}

void FileSet::replaces(const std::string& pattern) {
  if (state_ != nullptr) state_->replaces(pattern);
}

void FileSet::commit() {
  if (state_ == nullptr) return;
  living = nullptr;
  state_->commit();
}

bool put_aside(const fs::path& file, std::string_view bytes) {
  if (living == nullptr) return false;
  living->put(file, bytes);
  return true;
}

std::optional<fs::path> put_aside_as(const fs::path& path) {
  if (living == nullptr) return std::nullopt;
  return living->staged(path);
}

void recover_file_sets(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename().string().starts_with(kStaging)) left.push_back(entry.path());
  }
  for (const fs::path& path : left) {
    Descriptor lock(lock_staging(path));
    if (lock.get() >= 0) recover({fs::canonical(folder), path});
  }
}

}  // namespace dcnn
