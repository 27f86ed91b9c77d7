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

/// Progress over all steps that are not skipped, by their expected cost.
class Weights {
 public:
  explicit Weights(const std::vector<Step>& steps) {
    for (const Step& step : steps) total_ += step.seconds;
  }
  void skip(const Step& step) { total_ -= step.seconds; }
  void finish(const Step& step) { done_ += step.seconds; }
  double share(const Step& step, double within) const {
    return std::clamp((done_ + within * step.seconds) / std::max(total_, 1e-9), 0.0, 1.0);
  }

 private:
  double total_ = 0, done_ = 0;
};

void work_on(const Step& step, const std::string& identity, const Weights& weights,
             const ReproductionObserver& observer) {
  double furthest = 0;  // candidates of a preset begin anew
  const auto progress = [&](double share) {
    furthest = std::max(furthest, share);
    if (observer.progress) observer.progress(weights.share(step, furthest), step.name);
  };
  progress(0);
  step.work({observer.stop_wanted, progress, observer.note, identity});
}

}  // namespace

bool run_steps(const std::vector<Step>& steps, const std::filesystem::path& folder,
               const ReproductionObserver& observer, ReproductionOutcome& outcome) {
  Weights weights(steps);
  for (const Step& step : steps) {
    if (observer.stop_wanted && observer.stop_wanted()) return false;
    const std::string identity = sha256_hex({step.name, "\n", step.inputs()});
    const auto stamp = stamp_path(folder, step.name);
    if (is_done(step, stamp, identity)) {
      weights.skip(step);
      ++outcome.skipped;
      continue;
    }
    std::error_code ignored;
    std::filesystem::remove(stamp, ignored);  // what it says is about to become wrong
    const auto begin = std::chrono::steady_clock::now();
    try {
      work_on(step, identity, weights, observer);
    } catch (const Stopped&) {
      return false;
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    const Json written = {
        {"step", step.name}, {"inputs_sha256", identity}, {"seconds", took.count()}};
    write_file(stamp, written.dump(2) + "\n");
    weights.finish(step);
    ++outcome.done;
  }
  return true;
}

}  // namespace dcnn
