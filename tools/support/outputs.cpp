// SPDX-License-Identifier: Apache-2.0
#include "support/outputs.h"

#include <fnmatch.h>

#include <algorithm>
#include <array>

#include "dcnn/core/ranks.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  return fs::equivalent(a, b, missing);
}

/// "new/../log.csv" is log.csv once the folder is made.
fs::path when_made(const fs::path& path) {
  std::error_code error;
  if (path == "-" || fs::exists(fs::symlink_status(path, error))) return path;
  const fs::path plain = fs::weakly_canonical(path, error);
  return error || !fs::exists(plain, error) ? path : plain;
}

/// Where bytes for a path go, by one name for each place; empty where a stream takes them.
fs::path place_of(fs::path path) {
  constexpr int kMostLinks = 40;  // Linux follows as many
  if (is_standard_output(path)) return "-";
  std::error_code error;
  for (int links = 0; links < kMostLinks && fs::is_symlink(path, error); ++links) {
    path = path.parent_path() / fs::read_symlink(path, error);
  }
  if (fs::exists(path, error) && !fs::is_regular_file(path, error) &&
      !fs::is_directory(path, error))
    return {};
  path = fs::weakly_canonical(fs::absolute(path, error), error);
  return path.has_filename() ? path : path.parent_path();
}

bool matches(const std::string& pattern, const std::string& name) {
  return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

/// The existing files of a folder that a command would write.
std::vector<fs::path> present(const fs::path& folder, const std::vector<std::string>& contents) {
  std::vector<fs::path> found;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) {
    const std::string name = entry.path().filename();
    if (std::any_of(contents.begin(), contents.end(),
                    [&](const std::string& pattern) { return matches(pattern, name); })) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

bool is_empty_file(const fs::path& file) {
  std::error_code error;
  return fs::file_size(file, error) == 0 && !error;
}

bool is_stream(const fs::path& path) {
  std::error_code missing;
  return path == "-" || (fs::exists(path, missing) && !fs::is_regular_file(path, missing));
}

bool any_given(const std::vector<Option>& options) {
  return std::any_of(options.begin(), options.end(),
                     [](const Option& option) { return option.given(); });
}

/// Whether what is written by one option would replace what is written by the other.
bool overlap(const Output::Rule& one, const fs::path& at, const Output::Rule& other,
             const fs::path& there) {
  if (at.empty() || there.empty()) return false;
  if (one.is_folder() && other.is_folder()) {
    return at == there && std::any_of(one.contents.begin(), one.contents.end(), [&](const auto& a) {
             return std::any_of(other.contents.begin(), other.contents.end(),
                                [&](const auto& b) { return matches(a, b) || matches(b, a); });
           });
  }
  if (at == there) return true;
  const auto holds = [](const Output::Rule& rule, const fs::path& folder, const fs::path& file) {
    return rule.is_folder() && file.parent_path() == folder &&
           std::any_of(rule.contents.begin(), rule.contents.end(),
                       [&](const auto& pattern) { return matches(pattern, file.filename()); });
  };
  return holds(one, at, there) || holds(other, there, at);
}

}  // namespace

bool Output::Rule::is_folder() const { return !contents.empty() && !any_given(file_with); }

Output Outputs::add(Output::Rule rule) {
  rules_.push_back(std::make_shared<Output::Rule>(std::move(rule)));
  return Output(rules_.back());
}

std::vector<Outputs::Path> Outputs::inputs() const {
  std::vector<Path> all;
  for (const auto& paths : inputs_) {
    for (const Path& path : paths()) all.push_back(path);
  }
  return all;
}

void Outputs::claim(bool force) {
  if (!is_first_rank()) return;
  refuse_overlaps();
  for (const auto& rule : rules_) {
    if (rule->path().empty()) continue;
    const bool keep = !force && !any_given(rule->unless);
    rule->is_folder() ? claim_folder(*rule, keep) : claim_file(*rule, keep);
  }
}

bool is_standard_output(const std::filesystem::path& path) {
  constexpr std::array kNames{"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"};
  return std::find(kNames.begin(), kNames.end(), path) != kNames.end();
}

bool Outputs::take_standard_output() const {
  return std::any_of(rules_.begin(), rules_.end(), [&](const auto& rule) {
    return !rule->is_folder() && is_standard_output(rule->path());
  });
}

void Outputs::claim_file(const Output::Rule& rule, bool keep) {
  const Path path = when_made(rule.path());
  require(path == "-" || (!fs::is_directory(path) && path.has_filename()), Exit::kUsage,
          path.string(), ": is a folder; name a file");
  if (is_stream(path)) return;
  if (rule.held && !any_given(rule.unless)) names_.emplace_back(path);
  const auto existing = replaced_file(path);
  const Path folder = existing.value_or(path).parent_path();
  expect_writable(folder);
  sweep_temporaries(folder.empty() ? Path(".") : folder, path.filename());
  if (!existing) {
    if (keep) claim_new(path, rule.own);
    return;
  }
  refuse_input(*existing);
  require(!rule.precious, Exit::kUsage, path.string(),
          ": exists already and is never replaced, not with --force either; name another file");
  if (!keep || is_empty_file(*existing) || (rule.own && rule.own(*existing))) return;
  fail(Exit::kUsage, path.string(),
       ": exists already and is kept; name another file, or replace it with --force");
}

void Outputs::claim_folder(const Output::Rule& rule, bool keep) {
  const Path folder = rule.path();
  require(folder != "-", Exit::kUsage,
          "- is standard output, which takes one file, and a folder is written here; name one");
  require(!fs::exists(folder) || fs::is_directory(folder), Exit::kUsage, folder.string(),
          ": is no folder, and one is written here; name another");
  locks_.emplace_back(folder);
  const auto existing = present(folder, rule.contents);
  for (const Path& file : existing) refuse_input(file);
  require(!keep || existing.empty(), Exit::kUsage, folder.string(), ": holds a result already (",
          existing.empty() ? "" : existing.front().filename().string(),
          "), which is kept; name another folder, or replace it with --force");
  for (const std::string& name : rule.contents) {
    if (keep) claim_new(folder, name);
  }
}

void Outputs::refuse_input(const Path& output) const {
  for (const Path& input : inputs()) {
    require(!same_file(input, output), Exit::kUsage, output.string(),
            ": is also an input and would be destroyed; name another output");
  }
}

void Outputs::refuse_overlaps() const {
  std::vector<std::pair<const Output::Rule*, Path>> before;
  for (const auto& rule : rules_) {
    if (rule->path().empty()) continue;
    const Path at = place_of(rule->path());
    for (const auto& [other, there] : before) {
      require(!overlap(*rule, at, *other, there), Exit::kUsage, rule->path().string(), ": ",
              other->option.name(), " and ", rule->option.name(),
              " both write there, and one of them would be lost; name another output");
    }
    before.emplace_back(rule.get(), at);
  }
}

}  // namespace dcnn
