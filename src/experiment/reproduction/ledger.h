// Work in steps: each has files and the identity of what they were made from.
#pragma once

#include <functional>
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

/// Does what is not done yet, in order. A step is done when its files exist and the stamp in
/// `folder` has the hash of the same inputs. False when stopped.
bool run_steps(const std::vector<Step>& steps, const std::filesystem::path& folder,
               const ReproductionObserver& observer, ReproductionOutcome& outcome);

}  // namespace dcnn
