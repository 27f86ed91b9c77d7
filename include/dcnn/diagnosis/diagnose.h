// SPDX-License-Identifier: Apache-2.0
// What is missing in a simulator: located, named, modelled, and shown on recordings held out.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"
#include "dcnn/diagnosis/ablation.h"
#include "dcnn/physics/simulator.h"

namespace dcnn {

struct DiagnosisRequest {
  std::optional<std::filesystem::path> simulator;  ///< sim.json; none: columns *_sim
  std::optional<std::filesystem::path> system;     ///< system.json of another machine, instead
  Json arm;  ///< kinematics instead of those of `system`; or null
  std::vector<std::filesystem::path> fit, holdout;
  std::vector<std::filesystem::path> zeroed;  ///< of them, whose sensor was set to zero for each
  /// Of their rows, what is no reading: a channel that is frozen.
  struct NoReading {
    std::filesystem::path recording;
    double begin_s, end_s;  ///< in its own t
    std::string channel;
  };
  std::vector<NoReading> no_readings;
  /// Columns that the strength of a law may follow, beside `temperature` and those that a system
  /// description lists.
  std::vector<std::string> signals;
  ReadOptions read;
  std::optional<bool> shared_clock;  ///< none: shared where the times do not overlap
  Ablation without;                  ///< for research
};

/// A recording on which nothing was decided, or with blocks on which nothing was.
struct HeldOut {
  std::string recording;
  Eigen::VectorXd t;
  Eigen::MatrixXd measured, before, after;  ///< (T, targets)
  std::vector<char> held;                   ///< (T) 1 where the row was held out
};

/// A finding in the coordinate in which its law is a curve: (x, y) of what is left without it.
struct Portrait {
  std::string title, x_label, y_label;
  std::vector<double> x, left, law;
};

struct Diagnosis {
  Json report;          ///< report.json (docs/use/diagnose.md)
  Simulator corrected;  ///< of a wrist tool
  Json model;           ///< model.json: the corrected simulator of a tool or a machine
  std::vector<HeldOut> holdout;
  std::vector<Portrait> portraits;  ///< one per finding and coordinate of its law
};

/// Error(kData) for recordings or simulators that cannot be used. `progress` is told in words what
/// is being done; it may be empty.
Diagnosis diagnose(const DiagnosisRequest& request,
                   const std::function<void(const std::string&)>& progress);

/// Findings as a reader wants them: those of friction along one axis as one curve ("friction"), and
/// a spring whose numbers mean nothing as the constant that it is.
Json in_lines(const Json& findings);

/// False of a positive number (value, ci95) whose interval spans two decades: of a stiffness that
/// only a much finer motion would tell the recordings know a bound at most.
bool is_told(const Json& number);
/// Whether a finding, whatever may stand in its place, is rather wrong than right: held-out
/// channels speak against it, or it explains less than what no name does.
bool is_doubtful(const Json& finding);

/// What was found, in one plain sentence.
std::string headline(const Json& report);
/// By target, of the held-out recordings; of the fitted ones in reports that do not know theirs.
const Json& heldout_noise(const Json& fit);

}  // namespace dcnn
