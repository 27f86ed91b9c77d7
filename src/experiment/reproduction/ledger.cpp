#include "experiment/reproduction/ledger.h"

#include <algorithm>
#include <chrono>

#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"

namespace dcnn {
namespace {

std::filesystem::path stamp_path(const std::filesystem::path& folder, std::string name) {
  for (char& c : name) {
    if (c == '/' || c == ' ' || c == ':') c = '_';
  }
  return folder / (name + ".json");
}

bool is_done(const Step& step, const std::filesystem::path& stamp, const std::string& identity) {
  if (!std::filesystem::exists(stamp)) return false;
  const bool complete =
      std::all_of(step.files.begin(), step.files.end(),
                  [](const std::filesystem::path& file) { return std::filesystem::exists(file); });
  return complete && read_json(stamp, Exit::kFailure).value("inputs_sha256", "") == identity;
}

void work_on(const Step& step, const std::string& identity, const StepTimes& times,
             const ReproductionObserver& observer) {
  double furthest = 0;  // candidates of a preset begin anew
  const auto progress = [&](double share) {
    furthest = std::max(furthest, share);
    if (observer.progress) observer.progress(times.share(step, furthest), step.name);
  };
  progress(0);
  step.work({observer.stop_wanted, progress, observer.note, identity});
}

}  // namespace

StepTimes::StepTimes(const std::vector<Step>& steps) {
  for (const Step& step : steps) kinds_[name_of(step)].left += step.seconds;
}

/// "A/dcnn: training" is a training; scorings are told apart by their noise.
std::string StepTimes::name_of(const Step& step) { return step.name.substr(step.name.rfind(' ') + 1); }

void StepTimes::skip(const Step& step, double measured) {
  Kind& kind = kinds_[name_of(step)];
  kind.left -= step.seconds;
  if (measured > 0.0) kind.expected += step.seconds, kind.measured += measured;
}

void StepTimes::finish(const Step& step, double measured) {
  skip(step, measured);
  done_ += measured;
}

double StepTimes::factor(const Kind& kind) const {
  if (kind.expected > 0.0) return kind.measured / kind.expected;
  double expected = 0.0, measured = 0.0;
  for (const auto& [name, other] : kinds_) expected += other.expected, measured += other.measured;
  return expected > 0.0 ? measured / expected : 1.0;
}

double StepTimes::share(const Step& step, double within) const {
  double left = 0.0;
  for (const auto& [name, kind] : kinds_) left += kind.left * factor(kind);
  const double own = within * step.seconds * factor(kinds_.at(name_of(step)));
  return std::clamp((done_ + own) / std::max(done_ + left, 1e-9), 0.0, 1.0);
}

bool run_steps(const std::vector<Step>& steps, const std::filesystem::path& folder,
               const ReproductionObserver& observer, ReproductionOutcome& outcome) {
  StepTimes times(steps);
  for (const Step& step : steps) {
    if (observer.stop_wanted && observer.stop_wanted()) return false;
    const std::string identity = sha256_hex({step.name, "\n", step.inputs()});
    const auto stamp = stamp_path(folder, step.name);
    if (is_done(step, stamp, identity)) {
      times.skip(step, read_json(stamp, Exit::kFailure).value("seconds", 0.0));
      ++outcome.skipped;
      continue;
    }
    std::error_code ignored;
    std::filesystem::remove(stamp, ignored);  // what it says is about to become wrong
    const auto begin = std::chrono::steady_clock::now();
    try {
      work_on(step, identity, times, observer);
    } catch (const Stopped&) {
      return false;
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    const Json written = {
        {"step", step.name}, {"inputs_sha256", identity}, {"seconds", took.count()}};
    write_file(stamp, written.dump(2) + "\n");
    times.finish(step, took.count());
    ++outcome.done;
  }
  return true;
}

}  // namespace dcnn
