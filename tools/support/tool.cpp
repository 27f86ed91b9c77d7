#include "support/tool.h"

#include <iostream>
#include <numbers>

#include "dcnn/core/parallel.h"

namespace dcnn {

Tool::Tool(const std::string& name, const std::string& summary, const std::string& examples)
    : name_(name), app_(summary, name) {
  app_.set_version_flag("--version", name + " " DCNN_VERSION);
  app_.footer("\nExamples:\n" + examples +
              "\nSI units and radians everywhere. Exit codes: 0 done, 1 failure, 2 wrong usage, 3 "
              "bad data,\n"
              "4 bad model, 75 interrupted with the state saved.");
  app_.add_flag("--json", common_.json, "print the result as one JSON document on stdout");
  app_.add_flag("-q,--quiet", common_.quiet, "no progress and no notes");
  app_.add_option("--threads", common_.threads, "number of threads (default: all cores)")
      ->check(CLI::Range(1, 1024));
  app_.add_option("--seed", common_.seed, "seed of everything random");
}

int Tool::parse(int argc, char** argv) {
  try {
    app_.parse(argc, argv);
    return -1;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app_.exit(error);  // --help, --version
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

ReadFlags::ReadFlags(CLI::App& app) {
  app.add_option("--position-unit", position_unit_, "unit of positions in the recordings")
      ->check(CLI::IsMember({"m", "mm"}))
      ->capture_default_str();
  app.add_option("--angle-unit", angle_unit_, "unit of angles in the recordings")
      ->check(CLI::IsMember({"rad", "deg"}))
      ->capture_default_str();
  app.add_option("--force-sign", force_sign_, "-1 where the log holds the reaction")
      ->check(CLI::IsMember({1.0, -1.0}))
      ->capture_default_str();
  resample_ =
      app.add_option("--resample", resample_hz_,
                     "put irregular clocks on a regular one [Hz; default: the recording's rate]")
          ->expected(0, 1)
          ->check(CLI::NonNegativeNumber);
}

ReadOptions ReadFlags::options() const {
  ReadOptions options;
  if (position_unit_ == "mm") options.position_unit = 1e-3;
  if (angle_unit_ == "deg") options.angle_unit = std::numbers::pi / 180.0;
  options.force_sign = force_sign_;
  options.resample = resample_->count() > 0;
  options.resample_hz = resample_hz_;
  return options;
}

}  // namespace dcnn
