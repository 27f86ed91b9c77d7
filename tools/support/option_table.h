// SPDX-License-Identifier: Apache-2.0
// What a command takes: the one table from which --help, manual pages and completions are made.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "support/file_kind.h"

namespace dcnn {

struct OptionRow {
  std::vector<std::string> names;  ///< "-q", "--quiet"; one word without dashes for arguments
  std::string value;               ///< "FILE", "N"; empty for a flag
  std::string help;
  std::vector<std::string> choices = {};
  std::string bounds = {};    ///< "1 to 1024"
  std::string standard = {};  ///< what holds where it is not given
  std::string group = "Options";
  bool required = false, many = false, optional_value = false;
  int count = 0;                     ///< exactly so many values; 0: one, or any number
  std::string counted = {};          ///< what these are, "numbers rx ry rz"
  std::vector<FileKind> kinds = {};  ///< what its files must be, where that is recognised

  bool is_argument() const { return names.front().front() != '-'; }
  bool is_path() const { return value == "FILE" || value == "DIR"; }
  /// "--train FILE…", "-q, --quiet".
  std::string usage() const;
  /// Help, choices, bounds and default in one text.
  std::string words() const;
};

struct OptionTable {
  std::string name, summary, examples, version;
  std::vector<OptionRow> rows;

  /// Every name that begins with a dash.
  std::vector<std::string> names() const;
  /// Headings in the order of their first option.
  std::vector<std::string> groups() const;
};

std::string help_text(const OptionTable& table);
/// What a command prints that was given nothing: summary, usage, two examples.
std::string short_help(const OptionTable& table);
std::string manual_page(const OptionTable& table);
std::string bash_completion(const OptionTable& table);
std::string zsh_completion(const OptionTable& table);
std::string fish_completion(const OptionTable& table);

/// Manual page and completions as files of a folder: man1/NAME.1, bash/NAME, zsh/_NAME,
/// fish/NAME.fish.
void write_descriptions(const OptionTable& table, const std::filesystem::path& folder);

}  // namespace dcnn
