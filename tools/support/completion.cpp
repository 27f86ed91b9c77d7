// SPDX-License-Identifier: Apache-2.0
// Completions of a command for bash, zsh and fish.
#include <algorithm>

#include "support/option_table.h"

namespace dcnn {
namespace {

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

/// The first line of the help, shortened, without what the shells would read as their own.
std::string brief(const OptionRow& row) {
  std::string text = row.help.substr(0, row.help.find('\n'));
  for (char& c : text) {
    if (c == '\'' || c == '`' || c == '"') c = ' ';
    if (c == '[' || c == '(') c = '(';
    if (c == ']' || c == ')') c = ')';
    if (c == ':') c = ',';
    if (c == '$' || c == '\\') c = ' ';
  }
  return text;
}

std::string identifier(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return "_" + name;
}

}  // namespace

std::string bash_completion(const OptionTable& table) {
  const std::string function = identifier(table.name);
  std::string text =
      function +
      "() {\n"
      "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
      "  COMPREPLY=()\n"
      "  case $previous in\n";
  for (const OptionRow& row : table.rows) {
    if (row.is_argument() || row.value.empty()) continue;
    text += "    " + joined(row.names, "|") + ") ";
    if (!row.choices.empty()) {
      text += "COMPREPLY=($(compgen -W '" + joined(row.choices, " ") +
              "' -- \"$current\")); return ;;\n";
    } else if (row.is_path()) {
      text += "compopt -o default; return ;;\n";
    } else {
      text += "return ;;\n";
    }
  }
  return text +
         "  esac\n"
         "  if [[ $current == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W '" +
         joined(table.names(), " ") +
         "' -- \"$current\"))\n"
         "  else\n"
         "    compopt -o default\n"
         "  fi\n"
         "}\n"
         "complete -F " +
         function + " " + table.name + "\n";
}

std::string zsh_completion(const OptionTable& table) {
  std::string text = "#compdef " + table.name + "\n_arguments -s";
  for (const OptionRow& row : table.rows) {
    const std::string action = !row.choices.empty() ? "(" + joined(row.choices, " ") + ")"
                               : row.is_path()      ? "_files"
                                                    : " ";
    if (row.is_argument()) {
      text += " \\\n  '*:" + row.names.front() + ":_files'";
      continue;
    }
    for (const std::string& name : row.names) {
      const std::string value = row.value.empty() ? "" : ":" + row.value + ":" + action;
      text += " \\\n  '" + std::string(row.many ? "*" : "") + name + "[" + brief(row) + "]" +
              value + "'";
    }
  }
  return text + "\n";
}

namespace {

/// Every option for one command line: `command` is "dcnn-train", or "dcnn -n CONDITION".
std::string fish_options(const OptionTable& table, const std::string& command) {
  std::string text;
  for (const OptionRow& row : table.rows) {
    if (row.is_argument()) continue;
    text += "complete -c " + command;
    for (const std::string& name : row.names) {
      text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    if (!row.choices.empty())
      text += " -x -a '" + joined(row.choices, " ") + "'";
    else if (row.is_path())
      text += " -r -F";
    else if (!row.value.empty())
      text += " -x";
    text += " -d '" + brief(row) + "'\n";
  }
  return text;
}

}  // namespace

/// For "dcnn-train" and for "dcnn train": dcnn.fish reads the files of all verbs.
std::string fish_completion(const OptionTable& table) {
  const std::string verb = table.name.substr(table.name.find('-') + 1);
  return fish_options(table, table.name) +
         fish_options(table, "dcnn -n '__fish_seen_subcommand_from " + verb + "'");
}

}  // namespace dcnn
