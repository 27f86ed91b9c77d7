// SPDX-License-Identifier: Apache-2.0
// Forward dynamics of one axis of a machine: the motion that its drive makes.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/physics/axis_machine.h"

namespace dcnn {

/// drive = inertia·a + damping·v + stiffness·q + constant + what effects with memory add; sense as
/// in CorrectedAxis.
struct DrivenLaw {
  double sense = 1.0, inertia = 0.0, damping = 0.0, stiffness = 0.0, constant = 0.0;
  std::vector<EffectStream> memory = {};  ///< of the effects, at rest
};

/// Solves drive = coefficients · base + effects for the acceleration and integrates it.
class ForwardAxis {
 public:
  /// `dt` [s] is the step of the samples. Error(exit) naming `where` for an axis of an arm, one
  /// whose base is not made of position, velocity and acceleration (with a coefficient above zero
  /// for the latter), and an effect that does not run sample by sample or lies between the force
  /// and what is read (a low-pass, a clipping).
  ForwardAxis(const AxisMachine& machine, std::size_t axis, double dt, std::string where,
              Exit exit);

  /// (T, 2): position and velocity at the samples of `drive` (in the axis' unit), which is
  /// interpolated as a signal without power above half its rate (32 samples of a windowed sinc).
  /// States of effects begin in equilibrium. Newmark's average acceleration with the error of each
  /// step estimated from two halves (Richardson) and kept below `tolerance` of the largest position
  /// so far; a step in which the velocity turns ends at the turn. Error(kData) where no step is
  /// short enough.
  Eigen::MatrixXd run(const Eigen::VectorXd& drive, double position, double velocity,
                      double tolerance = 1e-5) const;

 private:
  DrivenLaw law_;
  double dt_ = 0.0;
  std::string where_;
};

/// The machine without the effects of an axis that cannot be simulated forwards, whose names are
/// appended to `left_out`.
AxisMachine forward_part(AxisMachine machine, std::size_t axis, std::vector<std::string>& left_out);

/// The numbers of an axis that its own motion can tell, as a report publishes them: coefficients of
/// its base, then parameters of effects that vary from one to another (no fixed scale).
class ForwardNumbers {
 public:
  ForwardNumbers(const AxisMachine& machine, std::size_t axis);
  const std::vector<std::string>& names() const { return names_; }  ///< with units: "inertia [kg]"
  Eigen::VectorXd values(const AxisMachine& machine) const;
  void set(AxisMachine& machine, const Eigen::VectorXd& values) const;

 private:
  struct Place {
    std::size_t effect;  ///< of CorrectedAxis::effects
    std::string key;
    double sign, shift;  ///< published = sign·internal + shift
  };
  std::size_t axis_;
  Eigen::Index coefficients_;
  std::vector<Place> places_;
  std::vector<std::string> names_;
};

}  // namespace dcnn
