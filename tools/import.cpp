// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>

#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/import/assemble.h"
#include "dcnn/import/summary.h"
#include "support/doctor.h"
#include "support/file_kind.h"
#include "support/import_flags.h"
#include "support/next_command.h"
#include "support/tool.h"

namespace {

using namespace dcnn;
using Path = std::filesystem::path;

constexpr const char* kExamples =
    "  dcnn-import log.bag --dry-run                   # what is in it, and what it would become\n"
    "  dcnn-import log.mcap --out run1                 # run1/log.csv and run1/import.json\n"
    "  dcnn-import next.mcap --recipe run1/import.json --out run2\n"
    "  dcnn-import forces.txt poses.txt --join --out run3    # one file per topic\n"
    "  dcnn-import odd.txt --columns t,fx,fy,fz,A,B,C --unit t=ms --out run4\n"
    "\n"
    "What is found is printed as a table. Units that only the size of the numbers tells, and\n"
    "choices between topics, are asked for (exit 3) with the option that answers.";

struct Request {
  std::vector<Path> logs;
  std::optional<Path> out, recipe;
  std::string command;  ///< as it was given, to be given again with more
  bool dry_run = false, join = false, assume = false;
  double resample_hz = 0.0;
  std::optional<Option> resample;
};

/// The command line that writes what this one finds, as a shell takes it.
std::string command_for_more(int argc, char** argv) {
  std::string command = "dcnn-import";
  for (int k = 1; k < argc; ++k) {
    if (std::string(argv[k]) != "--dry-run") command += " " + quoted_argument(argv[k]);
  }
  return command;
}

/// The logs of one recording each.
std::vector<std::vector<Path>> recordings_of(const Request& request) {
  if (request.join) return {request.logs};
  std::vector<std::vector<Path>> recordings;
  for (const Path& log : request.logs) recordings.push_back(split_paths(log));
  return recordings;
}

/// What the command line alone tells, before a folder is made.
void check_request(const Request& request) {
  require(!request.logs.empty(), Exit::kUsage, "name a log; see dcnn-import --help");
  for (const Path& log : request.logs) {
    require(log != "-", Exit::kUsage, "a log is read twice: write standard input to a file first");
    const FileKind kind = kind_of_file(log);
    if (kind != FileKind::kJson) expect_kind("dcnn-import", log, {FileKind::kRecording});
  }
  require(request.dry_run || request.out, Exit::kUsage,
          "say where recordings are written: --out DIR, or --dry-run");
}

void demand_answers(const Proposal& proposal, bool assume, const std::string& file) {
  std::vector<std::string> open = proposal.questions;
  if (!assume) open.insert(open.end(), proposal.guesses.begin(), proposal.guesses.end());
  if (open.empty()) return;
  std::string words = open[0];
  for (std::size_t k = 1; k < open.size(); ++k) words += "; " + open[k];
  fail(Exit::kData, file, ": ", words,
       proposal.questions.empty() ? " (--assume takes what is guessed)" : "");
}

/// Any recording that a tool would take, with a force or without.
ReadOptions of_any_tool() {
  ReadOptions options;
  options.static_list = true;
  options.motion_only = true;
  return options;
}

/// What the tools would say of the recording that was written, text keeping every number's value:
/// whether they would take it.
bool check_written(const Tool& tool, const Path& path, Table table, const System& system) {
  try {
    const Recording recording = make_recording({std::move(table), {}}, path, of_any_tool(), system);
    for (const auto& note : recording.notes) tool.note("  " + note);
    return true;
  } catch (const Error& error) {
    const std::string words = error.what();
    const bool clock = words.find("irregular clock") != std::string::npos;
    tool.note("note: the other tools would refuse it: " + words +
              (clock ? " (here: --resample)" : ""));
    return false;
  }
}

class Importer {
 public:
  Importer(const Tool& tool, const Request& request, const ImportFlags& flags)
      : tool_(tool), request_(request), flags_(flags) {}

  Exit run() {
    const auto recordings = recordings_of(request_);
    if (request_.recipe) {
      proposal_.recipe = read_recipe(*request_.recipe);
    } else {
      propose_for(recordings[0]);
    }
    if (!request_.dry_run) {
      FileSet files(*request_.out);
      for (const char* earlier : {"system.json", "clock-offset.svg"}) files.replaces(earlier);
      for (const auto& recording : recordings) write(recording);
      write_file(*request_.out / "import.json", to_json(proposal_.recipe).dump(2) + "\n");
      if (!picture_.empty()) write_file(*request_.out / "clock-offset.svg", picture_);
      files.commit();
      if (taken_) tell_faults();
      tool_.note("Next: " + next_);
    } else if (request_.recipe) {
      std::cout << describe(read_log(recordings[0], flags_.read()), proposal_.recipe);
    }
    if (tool_.common().json) Tool::print(json_);
    return Exit::kDone;
  }

 private:
  void propose_for(const std::vector<Path>& paths) {
    const ImportWishes wishes = flags_.wishes();
    ReadLogOptions read = flags_.read();
    read.command = request_.command;
    read.wanted = worth_keeping(wishes);
    const ForeignLog& log = first_.emplace(read_log(paths, read));
    proposal_ = propose(log, wishes);
    proposal_.recipe.files = static_cast<int>(paths.size());
    proposal_.recipe.text = flags_.read().text;
    if (request_.resample->given()) {
      proposal_.recipe.resample_hz = request_.resample_hz > 0.0 ? request_.resample_hz : -1.0;
    }
    json_ = describe_json(log, proposal_);
    if (!tool_.common().json) std::cout << describe(log, proposal_.recipe) << std::flush;
    for (const auto& note : log.notes) tool_.note("  note: " + note);
    for (const auto& note : proposal_.notes) tool_.note("  note: " + note);
    if (!wishes.arm.urdf.empty() && proposal_.recipe.orientation.kind != "joints") {
      tool_.note("  note: --urdf is not used: the log has an orientation of its own");
    }
    if (request_.logs.size() > 1 && !request_.join && proposal_.recipe.columns.empty()) {
      proposal_.questions.emplace_back(
          "of several logs each is a recording: say --join where they are parts of one");
    }
    if (!request_.dry_run) demand_answers(proposal_, request_.assume, log.file);
    const bool open = !proposal_.questions.empty() || !proposal_.guesses.empty();
    if (!open || !request_.dry_run) keep_what_is_named(paths);
    if (!request_.dry_run) return show_offset(log);
    for (const auto& ask : proposal_.questions) tool_.note("  to be said: " + ask);
    for (const auto& ask : proposal_.guesses) tool_.note("  guessed: " + ask);
    if (proposal_.questions.empty() && proposal_.guesses.empty()) show_offset(log);
  }

  /// Columns that were found by counting on from a said one may not have been kept: then the log is
  /// read again.
  void keep_what_is_named(const std::vector<Path>& paths) {
    if (holds(*first_, proposal_.recipe)) return;
    ReadLogOptions read = flags_.read();
    read.wanted = [this](const LogStream& stream, const std::string& channel) {
      return proposal_.recipe.names(stream, channel);
    };
    first_.emplace(read_log(paths, read));
  }

  /// Two streams, two clocks: says by how much they are off, applies it where that is asked for.
  void show_offset(const ForeignLog& log) {
    constexpr double kMostOffset = 0.5;  // s: beyond it the user says it
    const StreamOffset found = estimate_offset(log, proposal_.recipe, kMostOffset);
    if (found.stream.empty()) return;
    picture_ = picture_of(found);
    json_["clock_offset"] = {{"stream", found.stream},
                             {"seconds", found.offset.seconds},
                             {"half_of_95_percent_s", found.offset.half},
                             {"certain", found.offset.certain}};
    const auto asked = flags_.estimated_offsets();
    if (std::find(asked.begin(), asked.end(), found.stream) == asked.end()) {
      return tool_.note("  " + words_of(found));
    }
    require(found.offset.certain, Exit::kData, log.file, ": ", words_of(found),
            "; say --clock-offset ", found.stream, "=SECONDS");
    for (ClockRule& rule : proposal_.recipe.clocks) {
      if (rule.stream == found.stream) rule.offset += found.offset.seconds;
    }
    tool_.note("  clock of " + found.stream + " moved by " + std::to_string(found.offset.seconds) +
               " s, within " + std::to_string(found.offset.half) + " s (95 %)");
  }

  void write(const std::vector<Path>& paths) {
    std::string whole;
    for (const Path& path : paths) whole += (whole.empty() ? "" : "+") + path.string();
    Imported imported = imported_from(whole);
    Path stem = paths[0].filename();
    if (stem.empty()) stem = paths[0].parent_path().filename();
    const Path file = *request_.out / stem.replace_extension(".csv");
    for (const Path& other : written_) {
      require(other != file, Exit::kUsage, file.string(),
              ": two logs have this name; import them into two folders");
    }
    written_.push_back(file);
    write_csv(file, imported.table);
    const Json axes = axes_of(imported.table, proposal_.recipe);
    if (!axes.is_null()) write_file(*request_.out / "system.json", axes.dump(2) + "\n");
    tool_.note(file.string() + ": " + std::to_string(imported.table.values.rows()) + " rows, " +
               std::to_string(imported.table.columns.size()) + " columns");
    for (const auto& note : imported.notes) tool_.note("  " + note);
    if (proposal_.recipe.wrench.zeroed) {
      tool_.note("  zeroed: say so to dcnn-diagnose, --zeroed, or give it the log with --recipe");
    }
    const Path system = *request_.out / "system.json";
    const std::string next =
        axes.is_null() ? next_of_tool(imported.table, file) : next_of_axes(system, written_);
    const bool taken = check_written(tool_, file, std::move(imported.table),
                                     axes.is_null() ? System() : parse_system(axes, "system.json"));
    taken_ = taken_ && taken;
    next_ = taken_ ? next : "mend what the note says, then import again";
  }

  /// What dcnn-check would call likely in what was written.
  void tell_faults() const {
    CheckRequest check{written_, of_any_tool(), {}, {}};
    const Path system = *request_.out / "system.json";
    if (std::filesystem::exists(system)) check.system = system;
    try {
      for (const Suspicion& one : suspicions(check_logs(check))) tool_.note(one.line);
    } catch (const Error& error) {
      tool_.note(std::string("note: not checked: ") + error.what());
    }
  }

  /// The first log was read already where its recipe was found.
  Imported imported_from(const std::string& whole) {
    std::optional<ForeignLog> log;
    std::swap(log, first_);
    if (log && holds(*log, proposal_.recipe)) return assemble(*log, proposal_.recipe);
    log.reset();
    return import_recording(whole, proposal_.recipe, flags_.read());
  }

  const Tool& tool_;
  const Request& request_;
  const ImportFlags& flags_;
  Proposal proposal_;
  std::optional<ForeignLog> first_;  // until it is written
  Json json_ = Json::object();
  std::string picture_, next_;
  std::vector<Path> written_;
  bool taken_ = true;  // every recording by the other tools
};

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-import", "Makes recordings of logs in other formats.", kExamples);
  Request request;
  tool.option("logs", request.logs, "logs: " + known_formats());
  tool.flag("--dry-run", request.dry_run, "print what is found and write nothing");
  const Option recipe =
      tool.option("--recipe", request.recipe, "import.json of an earlier log of the same robot")
          .holds({FileKind::kRecipe});
  tool.flag("--join", request.join, "all logs are parts of one recording");
  tool.flag("--assume", request.assume, "take units and clocks as guessed by size")
      .excludes(recipe);
  request.resample = tool.option("--resample", request.resample_hz,
                                 "put rows on a regular clock [Hz; default: the log's rate]")
                         .value_optional()
                         .not_negative()
                         .excludes(recipe);
  tool.output("--out", request.out, "folder for recordings and import.json",
              {"*.csv", "import.json", "system.json", "clock-offset.svg"});
  const ImportFlags flags(tool, recipe);
  request.command = command_for_more(argc, argv);
  tool.check([&] { check_request(request); });

  return tool.run(argc, argv, [&] { return Importer(tool, request, flags).run(); });
}
