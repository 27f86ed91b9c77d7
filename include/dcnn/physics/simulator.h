// The rigid tool on a wrist sensor, and what can be wrong with such a model.
#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/core/options.h"
#include "dcnn/core/random.h"
#include "dcnn/data/derivative.h"
#include "dcnn/data/recording.h"

namespace dcnn {

/// sim.json (contract.md section 3): numbers of the tool and the sensor, SI, in S where not said.
struct ToolModel {
  double mass = 0.0;
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  std::optional<Eigen::Matrix3d> inertia;  ///< about the origin of S; torques are simulated if given
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< in B
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d sensor_rotation_rpy = Eigen::Vector3d::Zero();  ///< R_ES = Rz·Ry·Rx
  enum class Inertial { kFull, kLinear, kNone } inertial = Inertial::kFull;
  double sample_rate_hz = 500.0;
};

/// Motion of the sensor frame: what the force depends on. (T,3) blocks, SI.
struct Motion {
  Eigen::VectorXd t;
  std::vector<Eigen::Matrix3d> R_BS;
  Eigen::MatrixXd euler;                 ///< alpha,beta,gamma of E, continuous
  Eigen::MatrixXd v_B, a_B;              ///< of the sensor's origin, in B
  Eigen::MatrixXd w_S, dw_S;             ///< angular velocity and acceleration, in S
  Eigen::VectorXd temperature;           ///< degC, empty where not logged
  double dt = 0.0;
  std::vector<Segment> segments;
  Index samples() const { return t.size(); }
};

/// Forces and torques read in S as they pass down the chain of effects.
struct Wrench {
  Eigen::MatrixXd force;   ///< (T,3) N
  Eigen::MatrixXd torque;  ///< (T,3) N·m, or (0,3)
};

/// Where in the chain an effect acts (vocabulary.md): stages run in this order.
enum class Stage {
  kTool,        ///< changes the ToolModel (mass, com, gravity_tilt, inertial_terms)
  kForce,       ///< force on the tool
  kResonance,
  kSensor,      ///< misalignment, gain, crosstalk
  kDynamics,    ///< lowpass, delay
  kOffset,      ///< drifts, bias, hum
  kNoise,       ///< where the simulator adds sensor noise
  kSaturation,
  kQuantisation,
};

/// One effect as it stands in `hidden` (contract.md section 4) or in a corrected model.json.
struct EffectSpec {
  std::string effect;
  std::string axis;  ///< empty for none
  std::optional<std::pair<double, double>> interval_s;
  Json parameters;
};

/// One law of the catalogue (effects.def): name, stage and the exact law, applied in place.
struct EffectKind {
  const char* name;
  Stage stage;
  const char* equation;  ///< as in vocabulary.md, for help and reports
  /// The parameter names with the values used by examples and tests, JSON.
  const char* example;
  /// Changes the model before anything is computed (Stage::kTool), else null.
  void (*change)(ToolModel&, Options& parameters);
  /// Changes the wrench; internal states start at rest at the start of each segment's recording.
  void (*apply)(Wrench&, const Motion&, const EffectSpec&, const ToolModel&, Options& parameters);
};
std::vector<const EffectKind*> effect_kinds();

ToolModel parse_tool_model(const Json& json, const std::string& where, Exit exit);
Json to_json(const ToolModel& model);
std::vector<EffectSpec> parse_effects(const Json& list, const std::string& where, Exit exit);
Json to_json(const std::vector<EffectSpec>& effects);

/// A simulator: the rigid tool and the effects that act on it (none in sim.json, those found in model.json).
struct Simulator {
  ToolModel model;
  std::vector<EffectSpec> effects;
};
Simulator parse_simulator(const Json& json, const std::string& where, Exit exit);
Simulator read_simulator(const std::filesystem::path& path);  ///< Error(kData)

/// Force and torque of the rigid tool alone: F = m R^T (g - a_com) + bias (vocabulary.md), torque about
/// the origin of S: c x m(R^T(g - a_o)) - I dw - w x (I w).
Wrench rigid_wrench(const ToolModel& model, const Motion& motion);

/// The whole chain, stages in order; white or AR(1) sensor noise enters at Stage::kNoise where `noise` is given.
struct SensorNoise {
  double force = 0.0, torque = 0.0, ar = 0.0;  ///< N, N·m, AR(1) coefficient
};
Wrench simulate(const Simulator& simulator, const Motion& motion, const SensorNoise* noise, Rng* rng);

/// The motion of a recording: derivatives by `derivative`, measured rates where logged. A static list is at rest.
Motion motion_of(const Recording& recording, const ToolModel& model, const DerivativeSpec& derivative);

}  // namespace dcnn
