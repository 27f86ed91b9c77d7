// SPDX-License-Identifier: Apache-2.0
#include "core/file_steps.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <set>

#include "core/replace.h"
#include "dcnn/core/file.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;
using Kind = FileStep::Kind;

constexpr std::string_view kJournalBegin = "dcnn-set 1", kJournalEnd = "end";

bool is_there(const fs::path& path) {
  struct stat about {};
  return ::lstat(path.c_str(), &about) == 0;
}

bool is_regular(const fs::path& path) {
  struct stat about {};
  return ::lstat(path.c_str(), &about) == 0 && S_ISREG(about.st_mode);
}

bool renamed(const fs::path& from, const fs::path& to) {
  return ::rename(from.c_str(), to.c_str()) == 0;
}

/// The old file gets a second name; where a file system has no hard links, this one alone.
void keep_old(const FileStep& step) {
  if (is_there(step.old) || !is_there(step.to)) return;
  require(is_regular(step.to), Exit::kFailure, step.to.string(),
          ": cannot replace: is no regular file");
  const bool kept = ::link(step.to.c_str(), step.old.c_str()) == 0 || renamed(step.to, step.old);
  check_call(kept, Exit::kFailure, step.to, "cannot replace");
}

void go(const FileStep& step) {
  if (step.kind == Kind::kRemove) {
    if (is_there(step.old) || !is_there(step.to)) return;
    const bool removed = renamed(step.to, step.old);
    return check_call(removed, Exit::kFailure, step.to, "cannot remove");
  }
  if (!is_there(step.staged)) return;
  if (step.kind == Kind::kNew) {
    const bool made = rename_new(step.staged, step.to);
    require(made || errno != EEXIST, Exit::kUsage, step.to.string(),
            ": was made by somebody else meanwhile and is kept; name another output, or replace it "
            "with --force");
    return check_call(made, Exit::kFailure, step.to, "cannot write");
  }
  keep_old(step);
  const bool replaced = renamed(step.staged, step.to);
  check_call(replaced, Exit::kFailure, step.to, "cannot replace");
}

bool go_back(const FileStep& step) {
  if (step.kind != Kind::kRemove && !is_there(step.staged) && !renamed(step.to, step.staged)) {
    return false;
  }
  if (!is_there(step.old)) return true;
  if (!renamed(step.old, step.to)) return false;
  if (is_there(step.old))
    ::unlink(step.old.c_str());  // two names of one file: rename() did nothing
  return true;
}

bool go_back(const std::vector<FileStep>& steps) {
  bool done = true;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) done = go_back(*step) && done;
  return done;
}

void sync_folders(const std::vector<FileStep>& steps) {
  std::set<fs::path> folders;
  for (const FileStep& step : steps) folders.insert(folder_of(step.to));
  for (const fs::path& folder : folders) sync_folder(folder);
}

/// Without what may lie outside: a path of names alone, in no linked folder.
bool is_inside(const fs::path& path, const fs::path& folder) {
  if (path.empty() || path.is_absolute()) return false;
  for (const fs::path& name : path) {
    if (name.empty() || name == "." || name == "..") return false;
  }
  std::error_code error;
  fs::path there = fs::canonical(folder, error);
  if (path.has_parent_path()) there /= path.parent_path();
  return !error && fs::weakly_canonical(there, error) == there;
}

struct Journal {
  std::vector<FileStep> steps;
  bool all_outside = true;  ///< whether what was to be renamed outside has been
};

/// What is not of this form is no journal: its writer ended before the first rename.
std::optional<Journal> read_journal(const Staging& staging) {
  constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  if (!is_regular(staging.journal())) return std::nullopt;
  const std::string text = read_file(staging.journal(), kMostBytes, Exit::kFailure);
  std::vector<std::string> words;
  for (std::size_t begin = 0, end = 0; (end = text.find('\0', begin)) != text.npos;
       begin = end + 1) {
    words.push_back(text.substr(begin, end - begin));
  }
  if (words.size() < 2 || words.front() != kJournalBegin || words.back() != kJournalEnd ||
      words.size() % 3 != 2) {
    return std::nullopt;
  }
  Journal journal;
  for (std::size_t k = 1; k + 1 < words.size(); k += 3) {
    const std::string &kind = words[k], &number = words[k + 1], &path = words[k + 2];
    if (kind == "o") {
      journal.all_outside = journal.all_outside && !is_there(path);
      continue;
    }
    int n = -1;
    std::from_chars(number.data(), number.data() + number.size(), n);
    const bool known = kind == "r" || kind == "n" || kind == "d";
    if (!known || n < 0 || !is_inside(path, staging.folder)) return std::nullopt;
    journal.steps.push_back(staging.step(static_cast<Kind>(kind[0]), staging.folder / path, n));
  }
  return journal;
}

}  // namespace

FileStep Staging::step(FileStep::Kind kind, const fs::path& to, int number) const {
  const std::string name = std::to_string(number);
  return {kind, to, path / name, path / (name + ".old"), number, false};
}

void Staging::remove() const {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) fs::remove_all(path, error);
}

void carry_out(const std::vector<FileStep>& steps, const Staging& staging) {
  try {
    for (const FileStep& step : steps) go(step);
    sync_folders(steps);
  } catch (const Error& error) {
    if (go_back(steps)) throw;
    fail(error.exit(), error.what(),
         " (and files of this result could not be set back: ", staging.path.string(),
         " has them; the next command that writes to this folder does it)");
  }
  for (const FileStep& step : steps) {
    if (step.outside) ::unlink(step.old.c_str());
  }
}

std::string journal_text(const std::vector<FileStep>& steps, const Staging& staging) {
  std::string text = std::string(kJournalBegin) + '\0';
  for (const FileStep& step : steps) {
    const std::string path =
        step.outside ? step.staged.string() : step.to.lexically_relative(staging.folder).string();
    text += step.outside ? 'o' : static_cast<char>(step.kind);
    text += '\0' + std::to_string(step.number) + '\0' + path + '\0';
  }
  return text + std::string(kJournalEnd) + '\0';
}

void recover(const Staging& staging) {
  if (const auto journal = read_journal(staging)) {
    // What lies outside is renamed first: once it is, the rest follows; else nothing else was.
    bool undone = false;
    if (!journal->all_outside) {
      undone = go_back(journal->steps);
      require(undone, Exit::kFailure, staging.folder.string(),
              ": a result that was being replaced cannot be set back");
    } else {
      carry_out(journal->steps, staging);
    }
  }
  staging.remove();
}

}  // namespace dcnn
