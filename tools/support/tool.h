// SPDX-License-Identifier: Apache-2.0
// What every dcnn-<verb> shares: common flags, the table of options, one-line errors, exit codes.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"
#include "dcnn/nn/plan.h"
#include "support/option.h"
#include "support/option_table.h"
#include "support/outputs.h"

namespace dcnn {

/// Flags that every tool has.
struct CommonFlags {
  bool json = false, quiet = false, force = false;
};

class Tool {
 public:
  /// `examples` stands first in the --help text: lines that can be pasted.
  Tool(const std::string& name, const std::string& summary, const std::string& examples);
  ~Tool();

  /// `names` as CLI11 reads them: "--out", "-q,--quiet", or "models" for arguments without a flag.
  /// T: a number, text, a path, a vector or an optional of these. Paths are files that are read:
  /// no output may be one of them.
  template <typename T>
  Option option(const std::string& names, T& variable, const std::string& help);
  Option flag(const std::string& names, bool& variable, const std::string& help);
  /// A file that the command writes; with `contents` (names with * and ?) a folder of such files.
  /// What exists is kept without --force. T: a path or an optional one.
  template <typename T>
  Output output(const std::string& names, T& variable, const std::string& help,
                const std::vector<std::string>& contents = {});

  /// Files that the command reads without an option of their own, such as those of a folder.
  void reads(std::function<std::vector<std::filesystem::path>()> paths) {
    outputs_.add_input(std::move(paths));
  }

  /// --threads, for a command that shares its work among threads.
  void shares_work();

  /// Done when the command line is read and before anything is written or made.
  void check(std::function<void()> check) { checks_.push_back(std::move(check)); }

  const CommonFlags& common() const { return common_; }

  /// Parses, claims the outputs, then calls `body`. Returns the exit code; every failure has become
  /// one line on stderr.
  int run(int argc, char** argv, const std::function<Exit()>& body);

  /// A line on stderr, unless --quiet.
  void note(const std::string& text) const;
  /// One JSON document on stdout.
  static void print(const Json& json);

 private:
  OptionRow& add_row(const std::string& names, const std::string& value, const std::string& help);
  void add_common();
  OptionTable table() const;
  std::optional<int> answer(int argc, char** argv) const;
  int parse(int argc, char** argv);
  std::string unknown_word() const;
  std::string taker_of(const std::string& file) const;
  using FileCheck = void (*)(const std::string& place, const std::filesystem::path& file,
                             const std::vector<FileKind>& wanted);
  void check_inputs(const FileCheck& check) const;

  std::string name_, summary_, examples_;
  std::unique_ptr<CLI::App> app_;
  std::deque<OptionRow> rows_;  // options point to them
  Outputs outputs_;
  std::vector<std::function<void()>> checks_;
  CommonFlags common_;
  int threads_ = 0;
};

/// --seed, for a command in which something is random.
class SeedFlag {
 public:
  explicit SeedFlag(Tool& tool, const std::string& standard = "1");
  const std::optional<std::uint64_t>& given() const { return seed_; }
  std::uint64_t value() const { return seed_.value_or(1); }

 private:
  std::optional<std::uint64_t> seed_;
};

/// KG, or KG X Y Z, of --payload.
Payload payload_of(const std::vector<double>& numbers);

/// --position-unit, --angle-unit and --force-sign.
class UnitFlags {
 public:
  explicit UnitFlags(Tool& tool);
  ReadOptions options() const;
  /// The same for the command line of another tool.
  std::vector<std::string> words() const;
  /// None of them beside that option.
  void exclude(const Option& other);

 private:
  std::string position_unit_ = "m", angle_unit_ = "rad";
  double force_sign_ = 1.0;
  std::vector<Option> options_;
};

/// UnitFlags, --payload, --resample and --recipe.
class ReadFlags {
 public:
  explicit ReadFlags(Tool& tool);
  ReadOptions options() const;
  /// The same for the command line of another tool, but for the recipe.
  std::vector<std::string> words() const;
  const std::optional<std::filesystem::path>& recipe() const { return recipe_; }

 private:
  UnitFlags units_;
  double resample_hz_ = 0.0;
  std::vector<double> payload_;
  std::optional<std::filesystem::path> recipe_;
  std::optional<Option> resample_;
};

/// --precision.
class PrecisionFlag {
 public:
  explicit PrecisionFlag(Tool& tool);
  Precision value() const;

 private:
  std::string word_ = "single";
};

}  // namespace dcnn
