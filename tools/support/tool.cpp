#include "support/tool.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <numbers>

#include "dcnn/core/parallel.h"

namespace dcnn {

Tool::Tool(const std::string& name, const std::string& summary, const std::string& examples)
    : name_(name), app_(std::make_unique<CLI::App>(summary, name)) {
  app_->set_version_flag("--version", name + " " DCNN_VERSION);
  app_->footer("\nExamples:\n" + examples +
               "\nSI units and radians everywhere. Exit codes: 0 done, 1 failure, 2 wrong usage, 3 "
               "bad data,\n"
               "4 bad model, 75 interrupted with the state saved.");
  flag("--json", common_.json, "print the result as one JSON document on stdout");
  flag("-q,--quiet", common_.quiet, "no progress and no notes");
  option("--threads", common_.threads, "number of threads (default: all cores)").between(1, 1024);
  option("--seed", common_.seed, "seed of everything random");
}

Tool::~Tool() = default;

template <typename T>
Option Tool::option(const std::string& names, T& variable, const std::string& help) {
  return Option(*app_->add_option(names, variable, help));
}

using Path = std::filesystem::path;
template Option Tool::option(const std::string&, int&, const std::string&);
template Option Tool::option(const std::string&, double&, const std::string&);
template Option Tool::option(const std::string&, std::string&, const std::string&);
template Option Tool::option(const std::string&, Path&, const std::string&);
template Option Tool::option(const std::string&, std::optional<int>&, const std::string&);
template Option Tool::option(const std::string&, std::optional<Index>&, const std::string&);
template Option Tool::option(const std::string&, std::optional<double>&, const std::string&);
template Option Tool::option(const std::string&, std::optional<std::string>&, const std::string&);
template Option Tool::option(const std::string&, std::optional<Path>&, const std::string&);
template Option Tool::option(const std::string&, std::vector<Index>&, const std::string&);
template Option Tool::option(const std::string&, std::vector<double>&, const std::string&);
template Option Tool::option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Tool::option(const std::string&, std::vector<Path>&, const std::string&);

Option Tool::flag(const std::string& names, bool& variable, const std::string& help) {
  return Option(*app_->add_flag(names, variable, help));
}

int Tool::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    return -1;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app_->exit(error);  // --help, --version
    return fail_line(std::string(error.what()) + "; see " + name_ + " --help", Exit::kUsage);
  }
}

int Tool::run(int argc, char** argv, const std::function<Exit()>& body) {
  if (const int done = parse(argc, argv); done >= 0) return done;
  set_threads(common_.threads);
  try {
    const Exit exit = body();
    std::cout.flush();
    require(std::cout.good(), Exit::kFailure, "standard output: cannot write");
    return static_cast<int>(exit);
  } catch (const Error& error) {
    return fail_line(error.what(), error.exit());
  } catch (const std::bad_alloc&) {
    return fail_line("out of memory", Exit::kFailure);
  } catch (const std::exception& error) {
    return fail_line(std::string("internal error: ") + error.what(), Exit::kFailure);
  }
}

int Tool::fail_line(const std::string& message, Exit exit) const {
  std::string line = message;
  for (char& c : line) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  std::cerr << name_ << ": " << line << std::endl;
  return static_cast<int>(exit);
}

void Tool::note(const std::string& text) const {
  if (!common_.quiet) std::cerr << text << std::endl;
}

void Tool::print(const Json& json) { std::cout << json.dump(2) << "\n"; }

ReadFlags::ReadFlags(Tool& tool) {
  tool.option("--position-unit", position_unit_, "unit of positions in the recordings")
      .one_of({"m", "mm"})
      .with_default();
  tool.option("--angle-unit", angle_unit_, "unit of angles in the recordings")
      .one_of({"rad", "deg"})
      .with_default();
  tool.option("--force-sign", force_sign_, "-1 where the log holds the reaction")
      .one_of({1.0, -1.0})
      .with_default();
  resample_ =
      tool.option("--resample", resample_hz_,
                  "put irregular clocks on a regular one [Hz; default: the recording's rate]")
          .value_optional()
          .not_negative();
}

ReadOptions ReadFlags::options() const {
  ReadOptions options;
  if (position_unit_ == "mm") options.position_unit = 1e-3;
  if (angle_unit_ == "deg") options.angle_unit = std::numbers::pi / 180.0;
  options.force_sign = force_sign_;
  options.resample = resample_->given();
  options.resample_hz = resample_hz_;
  return options;
}

PrecisionFlag::PrecisionFlag(Tool& tool) {
  tool.option("--precision", word_,
              "what the model's convolutions multiply in: int16 is half again as fast, within the "
              "error of docs/performance.md")
      .one_of({"single", "int16"})
      .with_default();
}

Precision PrecisionFlag::value() const {
  return word_ == "int16" ? Precision::kInt16 : Precision::kSingle;
}

}  // namespace dcnn
