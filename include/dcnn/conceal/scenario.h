// Scenarios with concealed effects: an independent world that shares no physics with the fitter.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn::conceal {

/// What is hidden: an id of vocabulary.md (or one that it lacks), in its units and names.
struct Hidden {
  std::string effect;
  std::string axis;  ///< empty for none
  std::optional<std::pair<double, double>> interval_s;
  std::map<std::string, double> parameters;
  bool foreign = false;    ///< the id's law in another form: its numbers are not comparable
  double amplitude = 0.0;  ///< rms it alone makes on its strongest axis, in sensor noises
};

/// Rigid tool and gravity as the simulator at hand has them, SI, sensor frame.
struct Tool {
  double mass = 0.7;
  Eigen::Vector3d com{0.0, 0.0, 0.1}, bias{0.0, 0.0, 0.0};
  Eigen::Vector3d mounting{0.0, 0.0, 0.0};  ///< rpy of the sensor in the pose frame [rad]
  std::string inertial = "full";            ///< full, linear (-m a_o alone) or none
};

/// Sensor noise: `white`, `ar1`, `heteroscedastic`, `heavy`, `flicker` or `quantised` (0.5 mN).
struct Noise {
  std::string kind = "white";
  double sigma = 0.04, pose_m = 1e-5, pose_rad = 1e-5;  ///< N, m, rad
};

struct Recorded {
  std::string name;
  bool holdout = false;
  Eigen::VectorXd t;
  Eigen::MatrixXd pose;             ///< (T, 6) as read: x,y,z [m], alpha,beta,gamma [rad]
  Eigen::MatrixXd measured, clean;  ///< (T, 3) [N]: as read, and without noise and rounding
  Eigen::VectorXd temperature;      ///< (T) [degC], or empty
};

struct Scenario {
  std::string id, group;  ///< what draw() was asked for, and the part before the colon
  Tool tool;              ///< as the simulator at hand has it
  Noise noise;
  std::string motion;
  std::vector<Hidden> hidden;
  std::vector<Recorded> recordings;
};

/// Ids of vocabulary.md that a wrist force can show, and those beyond it.
const std::vector<std::string>& listed_effects();
const std::vector<std::string>& unlisted_effects();

/// Draws the scenario `id` = "group:value/effect/number" of a seed; the same arguments give the
/// same bytes. Groups, A being an amplitude in sensor noises: `single:A`, `foreign:A` (the listed
/// effect in another form), `poor:A` (on a motion that hardly excites), `faint:A`, `unlisted:A`,
/// `mixed:A` (unlisted, and a listed one drawn) with an effect; `double:A`, `triple:A`,
/// `collinear:A` (two neighbours) with effect `any`; `null:KIND` (a kind of noise, or `pose`) with
/// effect `none`. What changes nothing on the motion that was drawn for it (dry friction along an
/// axis that rests) is drawn anew, motion and all. Error(kUsage) for another id.
Scenario draw(const std::string& id, std::uint64_t seed);

/// Writes sim.json and one CSV per recording; returns the files to fit on and those held out.
struct Files {
  std::filesystem::path simulator;
  std::vector<std::filesystem::path> fit, holdout;
};
Files write(const Scenario& scenario, const std::filesystem::path& folder);

/// The answers, in the form of a report's findings, with what they were drawn from and
/// `oracle_rmse`: rms per axis of what the true law at the true pose leaves of the held-out
/// recordings, without their first and last 0.5 s.
Json truth(const Scenario& scenario);

}  // namespace dcnn::conceal
