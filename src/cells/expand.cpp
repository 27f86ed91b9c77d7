// SPDX-License-Identifier: Apache-2.0
#include "cells/expand.h"

#include <cctype>
#include <set>

#include "dcnn/core/options.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

using Texts = std::vector<std::string>;

std::string setting_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// The word of `{word}` that begins at `at`, empty where there is none; `${word}` is the shell's.
std::string placeholder(const std::string& text, std::size_t at) {
  if (text[at] != '{' || (at > 0 && text[at - 1] == '$')) return "";
  std::size_t end = at + 1;
  while (end < text.size() &&
         (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_')) {
    ++end;
  }
  return end < text.size() && text[end] == '}' ? text.substr(at + 1, end - at - 1) : "";
}

/// Puts the settings of one cell in the place of `{name}`.
class Substitution {
 public:
  Substitution(const Json& settings, const Options& place) : settings_(settings), place_(place) {}

  std::string text(const std::string& pattern) const {
    std::string out;
    for (std::size_t at = 0; at < pattern.size(); ++at) {
      const std::string word = placeholder(pattern, at);
      if (word.empty()) {
        out += pattern[at];
      } else {
        out += setting_text(value(word));
        at += word.size() + 1;
      }
    }
    return out;
  }

  Texts texts(const Texts& patterns) const {
    Texts out;
    for (const std::string& pattern : patterns) out.push_back(text(pattern));
    return out;
  }

  /// A text that is one placeholder becomes the value itself: a number stays a number.
  Json document(const Json& pattern) const {
    if (pattern.is_string()) {
      const auto whole = pattern.get<std::string>();
      const std::string word = whole.empty() ? "" : placeholder(whole, 0);
      return !word.empty() && word.size() + 2 == whole.size() ? value(word) : Json(text(whole));
    }
    if (pattern.is_array()) {
      Json out = Json::array();
      for (const Json& item : pattern) out.push_back(document(item));
      return out;
    }
    if (!pattern.is_object()) return pattern;
    Json out = Json::object();
    for (const auto& [key, item] : pattern.items()) out[key] = document(item);
    return out;
  }

 private:
  const Json& value(const std::string& word) const {
    const Json* found = settings_.find(word);
    if (found) return *found;
    place_.reject("commands", "names {", word, "}, which is no key of grid or list");
  }

  const Json& settings_;
  const Options& place_;
};

/// The values of one key of "grid": a list, or {"from": 1, "count": 5}.
std::vector<Json> grid_values(Options& grid, const std::string& name) {
  const Json raw = grid.raw(name);
  if (raw.is_array()) return raw.get<std::vector<Json>>();
  Options range = grid.child(name);
  const auto from = range.get<std::int64_t>("from"), count = range.get<std::int64_t>("count");
  range.finish();
  if (count < 1) grid.reject(name, "needs a count of at least 1");
  std::vector<Json> values;
  for (std::int64_t k = 0; k < count; ++k) values.emplace_back(from + k);
  return values;
}

/// Every point of "grid" with every item of "list".
std::vector<Json> all_settings(Options& place) {
  std::vector<Json> all{Json::object()};
  const Json list = place.raw("list");
  if (!list.is_null()) {
    if (!list.is_array() || list.empty()) place.reject("list", "must be a list of objects");
    all = list.get<std::vector<Json>>();
  }
  const Json raw = place.raw("grid");
  Options grid = place.child("grid");
  for (const auto& member : raw.items()) {
    const auto values = grid_values(grid, member.first);
    if (values.empty()) grid.reject(member.first, "has no values");
    std::vector<Json> crossed;
    crossed.reserve(all.size() * values.size());
    for (const Json& settings : all) {
      if (!settings.is_object()) place.reject("list", "must be a list of objects");
      for (const Json& value : values) {
        crossed.push_back(settings);
        crossed.back()[member.first] = value;
      }
    }
    all = std::move(crossed);
  }
  grid.finish();
  return all;
}

std::vector<Texts> commands_of(Options& place) {
  const Json raw = place.raw("commands");
  std::vector<Texts> commands;
  const auto is_command = [](const Json& line) {
    if (!line.is_array() || line.empty()) return false;
    for (const Json& word : line) {
      if (!word.is_string()) return false;
    }
    return true;
  };
  if (!raw.is_array() || raw.empty()) {
    place.reject("commands",
                 R"(must be a list of commands, [["dcnn-train", "--out", "out/m.dcnn"]])");
  }
  for (const Json& line : raw) {
    if (!is_command(line)) place.reject("commands", "must hold lists of words, not ", line.dump());
    commands.push_back(line.get<Texts>());
  }
  return commands;
}

/// "model=mlp,seed=3", from the settings in their order.
std::string default_name(const Json& settings) {
  std::string name;
  for (const auto& [key, value] : settings.items()) {
    name += (name.empty() ? "" : ",") + key + "=" + setting_text(value);
  }
  for (char& c : name) {
    if (c == '/') c = '_';
  }
  return name.empty() ? "cell" : name;
}

/// Files below the root that a word names: `in/…`, a file or a folder with all its files.
void add_inputs(const std::string& word, const fs::path& root, const Options& place, Cell& cell) {
  if (!word.starts_with("in/")) return;
  const fs::path below = fs::path(word.substr(3)).lexically_normal();
  if (below.empty() || *below.begin() == "..") {
    place.reject("commands", "names ", word, ", which is not below the folder ", root.string());
  }
  if (fs::is_regular_file(root / below)) {
    cell.inputs[below.string()];
  } else if (fs::is_directory(root / below)) {
    for (const auto& entry : fs::recursive_directory_iterator(root / below)) {
      if (entry.is_regular_file()) cell.inputs[fs::relative(entry.path(), root).string()];
    }
  } else {
    place.reject("commands", "names ", word, ", but ", (root / below).string(), " is not there");
  }
}

void add_inputs_of_document(const Json& json, const fs::path& root, const Options& place,
                            Cell& cell) {
  if (json.is_string()) return add_inputs(json.get<std::string>(), root, place, cell);
  if (!json.is_array() && !json.is_object()) return;
  for (const Json& item : json) add_inputs_of_document(item, root, place, cell);
}

/// A relative path that stays where it is put.
bool is_tame(const std::string& name) {
  const fs::path path(name);
  return !name.empty() && path.is_relative() && path == path.lexically_normal() &&
         *path.begin() != ".." && path != "." && !name.ends_with("/");
}

/// The cells of one object with "commands".
void expand_object(Options place, const fs::path& root, std::vector<Cell>& cells) {
  Cell pattern;
  pattern.commands = commands_of(place);
  pattern.name = place.get<std::string>("name", "");
  pattern.files = place.raw("files");
  pattern.keep = place.get<Texts>("keep", pattern.keep);
  pattern.drop = place.get<Texts>("drop", {});
  pattern.timeout_s = place.number("timeout_s", 0.0, 0.0, 1e9);
  const auto inputs = place.get<Texts>("inputs", {});
  const auto settings = all_settings(place);
  place.finish();
  for (const Json& one : settings) {
    const Substitution substitute(one, place);
    Cell cell = pattern;
    cell.settings = one;
    cell.name = pattern.name.empty() ? default_name(one) : substitute.text(pattern.name);
    if (!is_tame(cell.name))
      place.reject("name", "gives '", cell.name, "', which is no name of a folder");
    for (Texts& command : cell.commands) {
      command = substitute.texts(command);
      for (const std::string& word : command) add_inputs(word, root, place, cell);
    }
    cell.files = substitute.document(pattern.files);
    for (const auto& [name, document] : cell.files.items()) {
      if (!is_tame(name) || name == "in" || name == "out" || name == "stdout" || name == "stderr" ||
          name.starts_with("in/")) {
        place.reject("files", "gives '", name, "', which is no name of a file of a cell");
      }
      add_inputs_of_document(document, root, place, cell);
    }
    for (const std::string& input : substitute.texts(inputs)) {
      add_inputs("in/" + input, root, place, cell);
    }
    cells.push_back(std::move(cell));
  }
}

}  // namespace

std::vector<Cell> expand_cells(const Json& description, const std::string& where,
                               const fs::path& root) {
  std::vector<Cell> cells;
  if (!description.is_object() || !description.contains("cells")) {
    expand_object(Options(description, where, Exit::kUsage), root, cells);
    return cells;
  }
  Options whole(description, where, Exit::kUsage);
  const Json list = whole.raw("cells");
  whole.finish();
  if (!list.is_array() || list.empty()) whole.reject("cells", "must be a list of objects");
  for (std::size_t i = 0; i < list.size(); ++i) {
    expand_object(Options(list[i], where + ": cells[" + std::to_string(i) + "]", Exit::kUsage),
                  root, cells);
  }
  return cells;
}

}  // namespace dcnn
