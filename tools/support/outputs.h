// SPDX-License-Identifier: Apache-2.0
// What a command writes, and what it must not destroy: the rule of docs/use/outputs.md.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dcnn/core/claims.h"
#include "dcnn/core/file.h"
#include "support/option.h"

namespace dcnn {

/// Whether a path is standard output, which may be a file.
bool is_standard_output(const std::filesystem::path& path);

/// An option that names a file, or a folder of files, that the command writes.
class Output {
 public:
  using Path = std::filesystem::path;
  struct Rule {
    Option option;
    std::function<Path()> path;
    std::vector<std::string> contents = {};  ///< names in a folder, with * and ?; none: a file
    std::vector<Option> unless = {};         ///< options that go on with what is there
    std::vector<Option> file_with = {};      ///< options that make the folder a file
    bool (*own)(const Path&) = nullptr;      ///< whether an existing file may be replaced
    bool precious = false;                   ///< what exists is kept with --force, too
    bool held = false;                       ///< no other process may write it meanwhile

    bool is_folder() const;
  };

  explicit Output(std::shared_ptr<Rule> rule) : rule_(std::move(rule)) {}

  Output required() const { return rule_->option.required(), *this; }
  Output group(const std::string& heading) const { return rule_->option.group(heading), *this; }
  /// With this option the command goes on with a result that exists.
  Output unless(Option option) const { return rule_->unless.push_back(option), *this; }
  /// With this option it names a file, without it a folder.
  Output file_with(Option option) const { return rule_->file_with.push_back(option), *this; }
  /// An existing file is replaced where `own` says that it is an earlier, easily repeated result.
  Output replaces(bool (*own)(const Path&)) const { return rule_->own = own, *this; }
  /// Nothing that exists is replaced, with --force either.
  Output precious() const { return rule_->precious = true, *this; }
  /// Two commands with the same file at the same time: the second one is refused.
  Output held() const { return rule_->held = true, *this; }
  bool given() const { return rule_->option.given(); }

 private:
  std::shared_ptr<Rule> rule_;
};

/// The outputs of one command line.
class Outputs {
 public:
  using Path = Output::Path;

  Output add(Output::Rule rule);
  void add_input(std::function<std::vector<Path>()> paths) { inputs_.push_back(std::move(paths)); }
  bool empty() const { return rules_.empty(); }
  /// Every file that the command line names to be read.
  std::vector<Path> inputs() const;

  /// Error(kUsage) where an output is also an input, or where a result exists without `force`;
  /// then holds the output folders for this process alone.
  void claim(bool force);
  /// Whether a file goes to standard output, which then holds nothing else.
  bool take_standard_output() const;

 private:
  void claim_file(const Output::Rule& rule, bool keep);
  void claim_folder(const Output::Rule& rule, bool keep);
  void refuse_input(const Path& output) const;
  void refuse_overlaps() const;

  std::vector<std::shared_ptr<Output::Rule>> rules_;
  std::vector<std::function<std::vector<Path>()>> inputs_;
  std::vector<FolderLock> locks_;
  std::vector<NameLock> names_;
};

}  // namespace dcnn
