// SPDX-License-Identifier: Apache-2.0
// What a diagnosis is about: recordings, the simulator at hand, and the quantities both give.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/data/recording.h"
#include "dcnn/diagnosis/ablation.h"
#include "dcnn/physics/chain.h"
#include "dcnn/physics/simulator.h"
#include "diagnosis/work.h"

namespace dcnn {

/// Which axis of a machine a case is about.
struct AxisPlan {
  System system;
  std::size_t index = 0;
  std::vector<Index> columns;  ///< of its base simulator that are fitted
  /// 1 where what is measured drives the axis, -1 where it is the reaction to that.
  double sense = 1.0;
  bool base_is_known = false;       ///< its coefficients are those of the whole arm, and not fitted
  Eigen::MatrixXd base_deviations;  ///< then: how they may be off (ArmRegression::deviations())
  Eigen::VectorXd given;  ///< of an arm whose links are described: their parameters (10·joints)
  std::optional<BodyVector> payload = std::nullopt;  ///< found at an arm's flange
  const Axis& axis() const { return system.axes[index]; }
};

/// One recording, its motion, and what was measured and simulated in it.
struct Log {
  Recording recording;
  Motion motion;               ///< by Case::derivative
  Eigen::MatrixXd measured;    ///< (T, channels), low-passed where the case is
  Eigen::MatrixXd unfiltered;  ///< then: as logged; else no rows
  bool zeroed = false;         ///< its constant offset is its own, and fitted beside everything
  Wrench base;                 ///< of somebody else's simulator, added to ours; no rows without one
  /// Columns of a linear simulator whose coefficients are fitted, (T, channels) each.
  std::vector<Eigen::MatrixXd> regressors;
  /// What errors of a known base make of the channel, a standard deviation each, (T, errors).
  Eigen::MatrixXd base_errors;
};

struct Case {
  Simulator simulator;      ///< as given; an empty tool where somebody else's predicts
  bool own_tool = true;     ///< mass and centre of mass mean something
  bool has_inertia = true;  ///< what predicts knows the inertia of what moves (simulates_inertia())
  std::shared_ptr<const AxisPlan> axis;  ///< of another machine, seen as a force along x; or null
  /// Units of length and time in which shapes along the axis are looked for; 1 for a tool, and for
  /// a machine of usual size in rad or m and seconds.
  double axis_length = 1.0, axis_seconds = 1.0;
  std::map<std::string, double> top_speed;  ///< m/s (rad/s) along each line that friction may take
  bool axis_moves = true;                   ///< by more than the noise of its position
  bool rests_count = false;                 ///< rows at rest decide as others do (rest.h)
  Eigen::VectorXd base_coefficients;        ///< of the base simulator's columns that are used
  Eigen::VectorXd base_shift;               ///< of a known base, in its errors; empty: none
  double lowpass_hz =
      0.0;  ///< predictions pass the zero-phase filter that the measured have passed
  double motion_hz = 20.0;  ///< above it nothing commanded moves
  /// Up to which what is measured shows motion.
  double shown_hz() const { return lowpass_hz > 0.0 ? std::min(lowpass_hz, motion_hz) : motion_hz; }
  std::vector<int> channels;                ///< columns of (fx,fy,fz,tx,ty,tz) that are measured
  std::vector<std::string> targets, units;  ///< of the channels
  std::vector<Log> logs;                    ///< to fit on
  DerivativeSpec derivative;
  bool zeros_differ = false;  ///< the offset of each recording is its own, beside the common one
  bool shared_clock = true;
  double end_of_clock = 0.0;  ///< s, end of the last recording
  /// Values on a coarse lattice: what rounding makes of the mean of a noisy force depends on both.
  double rounding_step = 0.0, rounding_noise = 0.0;
  /// Columns of the recordings that the strength of a law may follow, with their least and greatest
  /// values in the fitted ones.
  struct Driver {
    std::string signal;
    double low, high;
  };
  std::vector<Driver> drivers;
  Ablation without;
  std::shared_ptr<Work> work = std::make_shared<Work>();  ///< shared by copies
  /// Of the search for laws that no effect describes: samples of each force that was tried.
  std::shared_ptr<Work> law_work = std::make_shared<Work>();

  Index channel_count() const { return static_cast<Index>(channels.size()); }
  bool has_torque() const { return !channels.empty() && channels.back() > 2; }
  bool is_static() const { return logs.front().motion.is_static(); }
  /// Forces alone: of torques, which have a step of their own, no effect tells it.
  bool is_rounded(Index channel) const {
    return rounding_step > 0.0 && channels[static_cast<std::size_t>(channel)] < 3;
  }
  bool has_clock() const { return logs.front().motion.has_clock; }
  double dt() const { return logs.front().motion.dt; }
};

/// Whether all recordings were zeroed: a common offset is then no finding.
bool has_own_offsets(const Case& study);

/// Duration of the longest recording, and from the beginning of the first to the end of the last
/// [s].
double longest_seconds(const Case& study);
double span_seconds(const Case& study);

/// Time at either end of a stretch of so many seconds in which what is derived from a pose is poor
/// [s]: the flank of the smoother's taper (data/spectral.cpp) and, where the whole motion of an
/// axis passes it rather than a hand's tremor, a period of the cut-off; a tenth of short ones.
double end_seconds(const Case& study, double length);
/// Motion beyond the smoother's cut-off has passed in one of the recordings.
bool moves_fast(const Case& study);
/// The segments of a log without these ends; of poses at rest as they are.
std::vector<Segment> inner_segments(const Case& study, std::size_t log);
/// Mean square of a channel of what is left there.
double mean_square(const Case& study, const std::vector<Eigen::MatrixXd>& left, Index channel);

/// The columns of a wrench that the case measures, (T, channels).
Eigen::MatrixXd measured_part(const Case& study, const Wrench& wrench);

/// The same case seen at every stride-th sample, for searches: motions and positions, and no
/// measurements.
Case thinned(const Case& study, Index stride);

/// The motion of a wrist recording by the case's estimator, with the signals that laws may follow.
Motion wrist_motion(const Log& log, const Case& study);

/// Motions of all logs by this estimator, which becomes the case's.
void set_derivative(Case& study, const DerivativeSpec& derivative);

}  // namespace dcnn
