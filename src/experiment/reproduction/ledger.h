// Work in steps: each has files and the identity of what they were made from.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "dcnn/experiment/reproduce.h"

namespace dcnn {

/// What a step may do while it works.
struct StepSession {
  std::function<bool()> stop_wanted;
  std::function<void(double)> progress;  ///< share of the step done
  std::function<void(const std::string&)> note;
  std::string identity;  ///< of this step
};

/// Thrown by a step that was stopped: its state, if it has one, is saved.
struct Stopped {};

struct Step {
  std::string name;                          ///< "A/dcnn: training"
  double seconds = 1;                        ///< expected, on two cores
  std::vector<std::filesystem::path> files;  ///< that it writes
  /// Everything the files depend on, asked for when the step's turn comes.
  std::function<std::string()> inputs;
  std::function<void(const StepSession&)> work;
};

/// How much of the work is done, in time: what steps of a kind (training, scoring, …) took on this
/// machine, beside what was expected of them, says what those to come will take.
class StepTimes {
 public:
  explicit StepTimes(const std::vector<Step>& steps);
  /// A step that was done earlier, and what it took then.
  void skip(const Step& step, double measured);
  void finish(const Step& step, double measured);
  /// In [0, 1], with `within` of `step` done.
  double share(const Step& step, double within) const;

 private:
  struct Kind {
    double left = 0.0, expected = 0.0, measured = 0.0;  ///< s; left: expected of steps to come
  };
  static std::string name_of(const Step& step);
  double factor(const Kind& kind) const;

  std::map<std::string, Kind> kinds_;
  double done_ = 0.0;  ///< s, measured in this run
};

/// Does what is not done yet, in order. A step is done when its files exist and the stamp in
/// `folder` has the hash of the same inputs. False when stopped.
bool run_steps(const std::vector<Step>& steps, const std::filesystem::path& folder,
               const ReproductionObserver& observer, ReproductionOutcome& outcome);

}  // namespace dcnn
