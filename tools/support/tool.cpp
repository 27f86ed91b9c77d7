// SPDX-License-Identifier: Apache-2.0
#include "support/tool.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "dcnn/core/blocking.h"
#include "dcnn/core/excerpt.h"
#include "dcnn/core/options.h"
#include "dcnn/core/parallel.h"
#include "dcnn/experiment/provenance.h"
#include "support/fail_line.h"
#include "support/usage_fault.h"

namespace dcnn {

Tool::Tool(const std::string& name, const std::string& summary, const std::string& examples)
    : name_(name),
      summary_(summary),
      examples_(examples),
      app_(std::make_unique<CLI::App>(summary, name)) {
  fail_in_one_line(name);
  app_->set_help_flag();
  app_->allow_extras();  // so that a mistyped option is named before what is missing without it
}

Tool::~Tool() = default;

namespace {

using Path = std::filesystem::path;

template <typename T>
struct Element {
  using type = T;
};
template <typename T>
struct Element<std::vector<T>> : Element<T> {};
template <typename T>
struct Element<std::optional<T>> : Element<T> {};
template <typename T>
using ElementOf = typename Element<T>::type;

template <typename T>
const char* value_name() {
  if (std::is_same_v<ElementOf<T>, Path>) return "FILE";
  if (std::is_same_v<ElementOf<T>, std::string>) return "TEXT";
  return std::is_integral_v<ElementOf<T>> ? "N" : "NUMBER";
}

std::vector<Path> paths_of(const Path& path) {
  return path.empty() ? std::vector<Path>{} : std::vector<Path>{path};
}
std::vector<Path> paths_of(const std::optional<Path>& path) { return paths_of(path.value_or("")); }
std::vector<Path> paths_of(const std::vector<Path>& paths) { return paths; }

constexpr const char* kEveryCommand = "Every command";

}  // namespace

template <typename T>
Option Tool::option(const std::string& names, T& variable, const std::string& help) {
  if constexpr (std::is_same_v<ElementOf<T>, Path>) {
    outputs_.add_input([&variable] { return paths_of(variable); });
  }
  OptionRow& row = add_row(names, value_name<T>(), help);
  row.many = !std::is_same_v<T, ElementOf<T>> && !std::is_same_v<T, std::optional<ElementOf<T>>>;
  return Option(*app_->add_option(names, variable, help), row);
}

template Option Tool::option(const std::string&, int&, const std::string&);
template Option Tool::option(const std::string&, Index&, const std::string&);
template Option Tool::option(const std::string&, double&, const std::string&);
template Option Tool::option(const std::string&, std::string&, const std::string&);
template Option Tool::option(const std::string&, Path&, const std::string&);
template Option Tool::option(const std::string&, std::optional<int>&, const std::string&);
template Option Tool::option(const std::string&, std::optional<Index>&, const std::string&);
template Option Tool::option(const std::string&, std::optional<double>&, const std::string&);
template Option Tool::option(const std::string&, std::optional<std::string>&, const std::string&);
template Option Tool::option(const std::string&, std::optional<Path>&, const std::string&);
template Option Tool::option(const std::string&, std::optional<std::uint64_t>&, const std::string&);
template Option Tool::option(const std::string&, std::vector<Index>&, const std::string&);
template Option Tool::option(const std::string&, std::vector<double>&, const std::string&);
template Option Tool::option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Tool::option(const std::string&, std::vector<Path>&, const std::string&);

template <typename T>
Output Tool::output(const std::string& names, T& variable, const std::string& help,
                    const std::vector<std::string>& contents) {
  OptionRow& row = add_row(names, contents.empty() ? "FILE" : "DIR", help);
  return outputs_.add({.option = Option(*app_->add_option(names, variable, help), row),
                       .path =
                           [&variable] {
                             const auto paths = paths_of(variable);
                             return paths.empty() ? Path() : paths.front();
                           },
                       .contents = contents});
}

template Output Tool::output(const std::string&, Path&, const std::string&,
                             const std::vector<std::string>&);
template Output Tool::output(const std::string&, std::optional<Path>&, const std::string&,
                             const std::vector<std::string>&);

Option Tool::flag(const std::string& names, bool& variable, const std::string& help) {
  OptionRow& row = add_row(names, "", help);
  return Option(*app_->add_flag(names, variable, help), row);
}

OptionRow& Tool::add_row(const std::string& names, const std::string& value,
                         const std::string& help) {
  OptionRow row{.names = {}, .value = value, .help = help};
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) row.names.push_back(name);
  return rows_.emplace_back(std::move(row));
}

void Tool::shares_work() {
  option("--threads", threads_, "number of threads (default: all cores)").between(1, 1024);
}

/// Options of every command, after its own.
void Tool::add_common() {
  if (!outputs_.empty()) {
    flag("--force", common_.force, "replace a result that exists").group(kEveryCommand);
  }
  flag("--json", common_.json, "print the result as one JSON document on stdout")
      .group(kEveryCommand);
  flag("-q,--quiet", common_.quiet, "no progress and no notes").group(kEveryCommand);
  add_row("-h,--help", "", "print this text").group = kEveryCommand;
  add_row("--version", "", "print the version").group = kEveryCommand;
}

OptionTable Tool::table() const {
  return {name_, summary_, examples_, DCNN_VERSION, {rows_.begin(), rows_.end()}};
}

/// What is answered without looking at other arguments: help, version, the table itself.
std::optional<int> Tool::answer(int argc, char** argv) const {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto has = [&](const char* word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (has("--help") || has("-h")) {
    std::cout << help_text(table());
  } else if (has("--version")) {
    std::cout << name_ << " " << DCNN_VERSION << "\n";
  } else if (words.size() == 2 && words[0] == "--describe") {  // while the programs are built
    write_descriptions(table(), words[1]);
  } else if (words.size() == 1 && words[0] == "--summary") {  // asked by dcnn
    std::cout << summary_ << "\n";
  } else if (words.empty()) {
    std::cout << short_help(table()) << std::flush;
    return fail_line(name_, "nothing to do; see " + name_ + " --help", Exit::kUsage);
  } else {
    return std::nullopt;
  }
  return static_cast<int>(Exit::kDone);
}

/// The first option that takes files such as this one, whose kind is told by the name where there
/// is none.
std::string Tool::taker_of(const std::string& file) const {
  FileKind kind = kind_of_file(file);
  if (kind == FileKind::kUnknown && Path(file).extension() == ".csv") kind = FileKind::kRecording;
  for (const OptionRow& row : rows_) {
    const bool takes = std::find(row.kinds.begin(), row.kinds.end(), kind) != row.kinds.end();
    if (takes && !row.is_argument()) return row.names.back();
  }
  return "";
}

/// What is wrong with the first argument that is no option of this command; empty where all are.
std::string Tool::unknown_word() const {
  for (const std::string& word : app_->remaining()) {
    if (!word.starts_with("-") || word == "-") {
      const std::string taker = taker_of(word);
      return "unexpected argument '" + word + "'" +
             (taker.empty() ? "" : "; did you mean " + taker + " " + word + "?");
    }
    const std::string name = word.substr(0, word.find('='));
    const std::string near = nearest_word(name, table().names());
    return name + " is no option" + (near.empty() ? "" : "; did you mean " + near + "?");
  }
  return "";
}

int Tool::parse(int argc, char** argv) {
  std::string fault;
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    fault = usage_fault(error, rows_);
  }
  if (const std::string unknown = unknown_word(); !unknown.empty()) fault = unknown;
  if (fault.empty()) return -1;
  try {
    // What is given comes before what is missing beside it: a file of another kind explains both.
    if (unknown_word().empty()) check_inputs(expect_kind);
  } catch (const Error& error) {
    return fail_line(name_, error.what(), error.exit());
  }
  return fail_line(name_, fault + "; see " + name_ + " --help", Exit::kUsage);
}

/// Calls `check` for every file of known kind that the command line names.
void Tool::check_inputs(const FileCheck& check) const {
  for (const OptionRow& row : rows_) {
    if (row.kinds.empty()) continue;
    const std::string& name = row.names.back();
    for (const std::string& file : app_->get_option(name)->results()) {
      check(row.is_argument() ? name_ : name, file, row.kinds);
    }
  }
}

namespace {

std::string command_line(int argc, char** argv) {
  std::string line = std::filesystem::path(argv[0]).filename();
  for (int k = 1; k < argc; ++k) line += std::string(" ") + argv[k];
  return line;
}

}  // namespace

int Tool::run(int argc, char** argv, const std::function<Exit()>& body) {
  add_common();
  if (const auto answered = answer(argc, argv)) {
    std::cout.flush();
    if (std::cout.good()) return *answered;
    return fail_line(name_, "standard output: cannot write", Exit::kFailure);
  }
  if (const int done = parse(argc, argv); done >= 0) return done;
  set_threads(threads_);
  fix_blocking();
  try {
    for (const auto& check : checks_) check();
    check_inputs(expect_kind);
    outputs_.claim(common_.force);
    if (outputs_.take_standard_output()) {
      require(!common_.json, Exit::kUsage,
              "--json and a result both go to standard output; name a file for the result");
      std::cout.rdbuf(std::cerr.rdbuf());  // what is said beside the result
    }
    check_inputs(expect_file);
    set_provenance({command_line(argc, argv), name_ + " " DCNN_VERSION, outputs_.inputs()});
    const Exit exit = body();
    std::cout.flush();
    require(std::cout.good(), Exit::kFailure, "standard output: cannot write");
    return static_cast<int>(exit);
  } catch (const std::exception&) {
    return tell_exception(name_);
  }
}

void Tool::note(const std::string& text) const {
  if (common_.quiet) return;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::cerr << excerpt(line, line.size()) << std::endl;
  }
}

void Tool::print(const Json& json) { std::cout << json.dump(2) << "\n"; }

SeedFlag::SeedFlag(Tool& tool, const std::string& standard) {
  tool.option("--seed", seed_, "seed of everything random (default: " + standard + ")")
      .not_negative();
}

PrecisionFlag::PrecisionFlag(Tool& tool) {
  tool.option("--precision", word_,
              "what the model's convolutions multiply in: int16 is half again as fast, within the "
              "error of docs/results/performance.md")
      .one_of({"single", "int16"})
      .with_default();
}

Precision PrecisionFlag::value() const {
  return word_ == "int16" ? Precision::kInt16 : Precision::kSingle;
}

}  // namespace dcnn
