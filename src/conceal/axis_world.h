// SPDX-License-Identifier: Apache-2.0
// The axis of a machine: its body, its motion at a high rate, and what its drive then shows.
#pragma once

#include "conceal/draws.h"

namespace dcnn::conceal {

/// Sizes of an axis. Lengths are in `position_unit`, efforts in `unit`.
struct AxisBody {
  std::string kind;  ///< joint, motor, linear or oscillator
  std::string unit, position_unit;
  double turn = 0.0;                ///< position of one turn; 0: it does not turn
  double reach = 1.0;               ///< half of the range of motion
  double hz = 1.0;                  ///< of the motion
  double centre = 0.0;              ///< about which it moves
  double effort = 1.0;              ///< rms that the rigid body is to need
  double fast = 1.0;                ///< 95th percentile of the speeds of the recordings to fit on
  double wide = 1.0, middle = 0.0;  ///< half of the range of their positions, and its middle
  /// Effort = inertia·a + viscous·v + stiffness·q + gravity·sin(2π q/turn + phase) + weight.
  double inertia = 0.0, viscous = 0.0, stiffness = 0.0, gravity = 0.0, phase = 0.0, weight = 0.0;

  double speed() const;  ///< typical largest: 2π hz reach [1/s]
};

/// Motion of one recording, before its first row and beyond its last, `per_row` samples a row.
struct AxisPath {
  double start = 0.0, step = 1e-3;  ///< clock of the first sample, s
  Eigen::Index before = 0, per_row = 8, rows = 0;
  Eigen::VectorXd q, v, a;

  double time(Eigen::Index i) const { return start + step * static_cast<double>(i); }
  /// Every row's sample of a signal at the path's rate.
  Eigen::VectorXd logged(const Eigen::VectorXd& signal) const;
};

/// Motions: tones, trapezoids, triangles, chirp, noise, one_way, reaches.
const std::vector<std::string>& axis_motions();
/// q, v and a of `samples` samples about the body's centre. `resting`: share of the time at rest of
/// the kinds that rest, 0 to 0.8.
void make_axis_motion(const std::string& kind, const AxisBody& body, double resting,
                      Eigen::Index samples, AxisPath& path, Rng& rng);

/// What the drive needs for the rigid body alone.
Eigen::VectorXd rigid_effort(const AxisBody& body, const AxisPath& path);

/// A law of axis_laws(): what it adds to the effort, or what it makes of it. Its force has unit
/// size where `size` is 1 (a reading is changed by that share).
bool is_axis_law(const std::string& id);
std::string class_of_axis_law(const std::string& id);
std::map<std::string, double> draw_axis_law(const std::string& id, const AxisBody& body, Rng& rng);
void add_axis_law(const AxisBody& body, const AxisPath& path, const Hidden& h,
                  const Eigen::VectorXd& rigid, Eigen::VectorXd& effort);

/// Adds what the drive needs more for a force of the catalogue; nothing for other effects.
void add_axis_force(const AxisPath& path, const Hidden& h, const Eigen::VectorXd& rigid,
                    Eigen::VectorXd& effort);
/// What the sensor shows at the path's rate, before noise, clipping and rounding: forces, what is
/// made of the sum, offsets.
Eigen::VectorXd axis_effort(const AxisBody& body, const AxisPath& path,
                            const std::vector<Hidden>& hidden);
/// First-order lag of `tau` [s] over a signal at the path's rate; as it is where tau is 0.
Eigen::VectorXd lagged(const AxisPath& path, const Eigen::VectorXd& signal, double tau);

/// Kind of law of an effect, listed or not: friction, spring, ripple, scale, offset, lag, mode or
/// digits.
std::string axis_class(const std::string& effect);
/// The effect with drawn shapes and unit strength, in the axis' units.
Hidden draw_axis_effect(const std::string& id, const AxisBody& body, Rng& rng);
/// Multiplies its strengths; they stop where no machine has more.
Hidden stronger(Hidden h, const AxisBody& body, double factor);

}  // namespace dcnn::conceal
