// SPDX-License-Identifier: Apache-2.0
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
#include "dcnn/data/recording.h"

namespace dcnn::conceal {

/// What is hidden: an effect of the catalogue (or one that it lacks), in its units and names.
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
  /// Point masses, each an equal part of the mass, about the centre [m]; where there are any the
  /// sensor reads torques about its origin too.
  std::vector<Eigen::Vector3d> beads = {};
  Eigen::Vector3d bias_torque{0.0, 0.0, 0.0};  ///< N·m
};

/// Sensor noise: `white`, `ar1`, `heteroscedastic`, `heavy`, `flicker` or `quantised` (0.5 mN).
struct Noise {
  std::string kind = "white";
  double sigma = 0.04, pose_m = 1e-5, pose_rad = 1e-5;  ///< N, m, rad
};

/// Under which conditions a scenario is recorded: what its family adds to the plain ones.
struct Conditions {
  std::string family = "plain";
  int samples_per_reading = 8;  ///< of the 4000 Hz world: 8 is a log of 500 Hz
  /// Tremor of the hand on the pose: centre frequency, width [Hz] and rms of positions and angles.
  double tremor_hz = 0.0, tremor_width_hz = 1.0, tremor_m = 0.0, tremor_rad = 0.0;
  double tremor_period_s = 0.0;  ///< of bursts; 0: steady
  /// Noise of each axis relative to Noise::sigma, and its growth with the force on the axis:
  /// deviation = sigma·axis·(1 + growth·|F|/N).
  Eigen::Vector3d axis{1.0, 1.0, 1.0};
  double growth = 0.0;
  double burst = 1.0;     ///< factor of the noise in seconds drawn at random (one in six)
  double lost = 0.0;      ///< share of the rows that the log lacks, one to three in a row
  double jitter = 0.0;    ///< rms of the error of t, in steps
  double seconds = 0.0;   ///< of a recording; 0: 25 to 45
  double torque_m = 0.0;  ///< noise of torques over Noise::sigma [m]; 0: forces alone are read

  double hz() const { return 4000.0 / samples_per_reading; }
};

/// The room's temperature [degC] over the clock: warms up and swings.
struct Climate {
  double start = 21.0, rise = 0.0, settle_s = 60.0, swing = 0.0, period_s = 90.0;
  double operator()(double t) const;
};

struct Recorded {
  std::string name;
  bool holdout = false;
  Eigen::VectorXd t;
  Eigen::MatrixXd pose;  ///< (T, 6) as read: x,y,z [m], alpha,beta,gamma [rad]
  /// (T, 3) [N], or (T, 6) with [N·m]: as read, and without noise and rounding.
  Eigen::MatrixXd measured, clean;
  Eigen::VectorXd temperature;  ///< (T) [degC], or empty
};

struct Scenario {
  std::string id, group;  ///< what draw() was asked for, and the part before the colon
  Tool tool;              ///< as the simulator at hand has it
  Noise noise;
  Conditions conditions;
  std::string motion;
  Climate climate;
  std::vector<Hidden> hidden;
  std::vector<Recorded> recordings;
};

/// Ids of the catalogue that a wrist force can show, and those beyond it.
const std::vector<std::string>& listed_effects();
const std::vector<std::string>& unlisted_effects();
/// Laws that hardware has beside those: of a wrist tool, and further ones of an axis of a machine.
const std::vector<std::string>& hardware_effects();
const std::vector<std::string>& axis_effects();
/// Whether a diagnosis may name it: any but the unlisted ones.
bool is_listed(const std::string& effect);
/// Laws with drawn numbers, directions and places, by which a discovery is judged.
const std::vector<std::string>& drawn_laws();

/// Families of conditions: `plain` (500 Hz, 25 to 45 s, noise of one level), `tremor` (a hand's, 4
/// to 14 Hz), `load` (noise of each axis its own, growing with the force, in bursts), `clock` (200
/// to 2000 Hz, rows lost, an uneven clock), `field` (some of each, recordings of 12 to 60 s),
/// `hardware` (plain conditions, one of hardware_effects() where another family has a listed one)
/// and `wrench` (plain conditions; torques are read too, and forces act at a distance).
const std::vector<std::string>& families();

/// Draws the scenario `id` = "group:value/effect/number", or "family+group:value/effect/number", of
/// a seed; the same arguments give the same bytes. Groups, A being an amplitude in sensor noises:
/// `single:A`, `foreign:A` (the listed effect in another form), `poor:A` (on a motion that hardly
/// excites), `faint:A`, `unlisted:A`, `mixed:A` (unlisted, and a listed one drawn) with an effect;
/// `law:A` (one of drawn_laws()), `double:A`, `triple:A`, `collinear:A` (two neighbours) with
/// effect `any`; `null:KIND` (a kind of noise, or `pose`) with effect `none`. What changes nothing
/// on the motion that was drawn for it (dry friction along an axis that rests) is drawn anew,
/// motion and all. Error(kUsage) for another id.
Scenario draw(const std::string& id, std::uint64_t seed);

/// One more recording to fit on: the same tool, effects, sensor and conditions while the robot
/// follows the pose of `motion`. Its clock begins some 5 s after the last recording; what acts to
/// the end of the clock goes on.
void record_on(Scenario& scenario, const Recording& motion, std::uint64_t seed);

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
