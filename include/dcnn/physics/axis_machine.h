// SPDX-License-Identifier: Apache-2.0
// Machines that are a set of axes (system.json of kind "axes"): what their motion is, what the
// simulator at hand says, and a corrected simulator. An axis passes the same chain of effects as a
// tool: its drive's reaction is a force along base x, its position the angle alpha.
#pragma once

#include <filesystem>
#include <optional>

#include "dcnn/data/system.h"
#include "dcnn/physics/chain.h"
#include "dcnn/physics/simulator.h"

namespace dcnn {

/// The motion of one axis: logged rates where declared, else derivatives by `derivative`.
Motion axis_motion(const Recording& recording, const Axis& axis, const DerivativeSpec& derivative);

/// Whether anything of the motion that the axis' simulator needs is derived from other columns.
bool is_derived(const System& system, std::size_t axis);

/// The columns that the axis' base simulator is linear in, (T, columns): those of "base" (an empty
/// list: a constant), or of the arm's rigid body; none where the axis has "simulated". Error(kData)
/// where the description gives no simulator or a column is missing.
Eigen::MatrixXd base_columns(const Recording& recording, const System& system, std::size_t axis,
                             const DerivativeSpec& derivative);
/// Their names.
std::vector<std::string> base_names(const System& system, std::size_t axis);

/// The arm of a system description, one joint for each axis.
JointChain chain_of(const System& system);
/// (T, 10): what each parameter of a body at an arm's flange, in the flange's frame, adds to the
/// drive of a joint.
Eigen::MatrixXd payload_columns(const Recording& recording, const System& system, std::size_t axis,
                                const DerivativeSpec& derivative);

/// What acts on the drive of one axis.
struct CorrectedAxis {
  std::vector<Eigen::Index> columns;  ///< of base_columns() that are used
  Eigen::VectorXd coefficients;       ///< of these
  std::vector<EffectSpec> effects;    ///< on the reaction: axes base_x, alpha:base_x, sensor_x
  DerivativeSpec derivative;
  double sense = 1.0;  ///< -1 where the measured is the reaction to the drive
};

/// model.json of a machine: its system description and what corrects each axis.
struct AxisMachine {
  System system;
  std::vector<CorrectedAxis> axes;
  std::optional<BodyVector> payload =
      std::nullopt;  ///< of an arm, in the flange's frame, beside what the base has
};
Json to_json(const AxisMachine& machine);
AxisMachine parse_axis_machine(const Json& json, const std::string& where, Exit exit);
/// The machine of a description that gives the bodies of all of an arm's links, nothing else
/// acting. Error(kData) for another one.
AxisMachine machine_of(const System& system);
/// Whether a model.json is one of a machine rather than of a wrist tool.
bool is_axis_machine(const Json& json);

/// The system of a description, or of a model.json of a machine.
System system_in(const Json& json, const std::string& where);

/// What `found` adds to a machine, in one chain with its own effects.
AxisMachine with_more(AxisMachine machine, const AxisMachine& found);

/// (T, axes): what the machine's drives would show, in the axes' units, low-passed as the system
/// says.
Eigen::MatrixXd predict_axes(const AxisMachine& machine, const Recording& recording);

/// An effect's number as it is published for an axis: the stem of its name ("fc"), the axis'
/// unit, and the sign of the drive rather than of its reaction.
struct AxisParameter {
  std::string stem, unit;
  double sign = 1.0;  ///< published = sign·internal + shift
  double shift = 0.0;
};
/// None for components that an axis does not have (_y, _z).
std::optional<AxisParameter> axis_parameter(const EffectKind& kind, const std::string& name,
                                            const Axis& axis, double sense);

/// The recording with what the machine's drives show in the measured columns, in the log's own
/// units.
Recording predict_motion(const AxisMachine& machine, const Recording& motion);

}  // namespace dcnn
