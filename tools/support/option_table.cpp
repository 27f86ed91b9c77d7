// SPDX-License-Identifier: Apache-2.0
#include "support/option_table.h"

#include <algorithm>

#include "dcnn/core/file.h"

namespace dcnn {
namespace {

constexpr std::size_t kWidth = 96, kIndent = 26;

/// Characters of UTF-8, not bytes.
std::size_t length(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

/// Words in lines of at most kWidth, the first line beginning at column `at`; line breaks stay.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t at) {
  std::string out, word;
  std::size_t column = at;
  const auto put = [&] {
    if (word.empty()) return;
    if (column > indent && column + 1 + length(word) > kWidth) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      out += " ";
      ++column;
    }
    out += word;
    column += length(word);
    word.clear();
  };
  for (const char c : text) {
    if (c != ' ' && c != '\n') {
      word += c;
      continue;
    }
    put();
    if (c == '\n') {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    }
  }
  put();
  return out;
}

std::string row_text(const OptionRow& row) {
  std::string line = "  " + row.usage();
  if (length(line) + 2 > kIndent) {
    line += "\n" + std::string(kIndent, ' ');
  } else {
    line += std::string(kIndent - length(line), ' ');
  }
  return line + wrapped(row.words(), kIndent, kIndent) + "\n";
}

std::string usage_line(const OptionTable& table) {
  std::string line = "Usage: " + table.name;
  bool optional = false;
  for (const OptionRow& row : table.rows) {
    if (row.is_argument() || row.required) {
      line += " " + (row.required ? row.usage() : "[" + row.usage() + "]");
    } else {
      optional = true;
    }
  }
  return line + (optional ? " [options]\n" : "\n");
}

std::string first_lines(const std::string& text, int count) {
  std::size_t end = 0;
  while (count-- > 0 && end != text.npos && end < text.size()) {
    end = text.find('\n', end);
    if (end != text.npos) ++end;
  }
  return text.substr(0, end);
}

}  // namespace

std::string OptionRow::usage() const {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  if (is_argument()) return many ? text + "…" : text;
  if (value.empty()) return text;
  const std::string shown = many ? value + "…" : value;
  return text + " " + (optional_value ? "[" + shown + "]" : shown);
}

std::string OptionRow::words() const {
  std::string extra;
  const auto add = [&](const std::string& word) { extra += (extra.empty() ? "" : "; ") + word; };
  if (required) add("required");
  if (!choices.empty()) {
    std::string list;
    for (const std::string& choice : choices) list += (list.empty() ? "" : ", ") + choice;
    add(list);
  }
  if (!bounds.empty()) add(bounds);
  if (!standard.empty()) add("default: " + standard);
  return extra.empty() ? help : help + " (" + extra + ")";
}

std::vector<std::string> OptionTable::names() const {
  std::vector<std::string> all;
  for (const OptionRow& row : rows) {
    if (!row.is_argument()) all.insert(all.end(), row.names.begin(), row.names.end());
  }
  return all;
}

std::vector<std::string> OptionTable::groups() const {
  std::vector<std::string> all;
  for (const OptionRow& row : rows) {
    if (std::find(all.begin(), all.end(), row.group) == all.end()) all.push_back(row.group);
  }
  return all;
}

std::string help_text(const OptionTable& table) {
  std::string text = wrapped(table.summary, 0, 0) + "\n\n" + usage_line(table) + "\nExamples:\n" +
                     table.examples + (table.examples.ends_with('\n') ? "" : "\n");
  for (const std::string& group : table.groups()) {
    text += "\n" + group + ":\n";
    for (const OptionRow& row : table.rows) {
      if (row.group == group) text += row_text(row);
    }
  }
  return text +
         "\nSI units and radians everywhere. Exit codes: 0 done, 1 failure, 2 wrong usage, 3 bad "
         "data,\n4 bad model, 75 interrupted with the state saved.\n";
}

std::string short_help(const OptionTable& table) {
  return wrapped(table.summary, 0, 0) + "\n\n" + usage_line(table) + "\n" +
         first_lines(table.examples, 2) + "\n" + table.name + " --help has all options.\n";
}

void write_descriptions(const OptionTable& table, const std::filesystem::path& folder) {
  write_file(folder / "man1" / (table.name + ".1"), manual_page(table));
  write_file(folder / "bash" / table.name, bash_completion(table));
  write_file(folder / "zsh" / ("_" + table.name), zsh_completion(table));
  write_file(folder / "fish" / (table.name + ".fish"), fish_completion(table));
}

}  // namespace dcnn
