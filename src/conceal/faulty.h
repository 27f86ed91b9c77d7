// SPDX-License-Identifier: Apache-2.0
// The parts of a faulty log: which clean one it begins as, and what is done to it.
#pragma once

#include "dcnn/conceal/faulty.h"
#include "dcnn/core/random.h"

namespace dcnn::conceal {

/// Clean logs: a wrist with Euler angles, on a motion whose accelerations count, with a quaternion,
/// with logged rates, with torques, zeroed in another
/// pose before; that hardly turns; poses at rest; three joints, three
/// motors behind gears; an arm with its
/// description, one of six joints, one that hangs from a ceiling or a wall though it is described
/// upright, one whose torques hold no weight.
enum class CleanLog {
  kEuler,
  kBrisk,
  kQuaternion,
  kRates,
  kTorque,
  kZeroedBefore,
  kStill,
  kStatic,
  kJoints,
  kMotors,
  kArm,
  kSixJoints,
  kHanging,
  kOnWall,
  kWeightless
};

FaultyLog make_clean(CleanLog kind, Rng& rng);
/// Of the kinds from kArm on.
FaultyLog make_arm(CleanLog kind, Rng& rng);

/// Rounded to so many steps a unit, as a logger writes it.
double rounded(double value, double per_unit);

Eigen::Index column_of(const Table& table, const std::string& name);
Eigen::Ref<Eigen::VectorXd> column(Table& table, const std::string& name);
void append(Table& table, const std::string& name, const Eigen::VectorXd& values);
void remove(Table& table, const std::string& name);

}  // namespace dcnn::conceal
