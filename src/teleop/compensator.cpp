#include <algorithm>
#include <array>
#include <cmath>

#include "data/feature_blocks.h"
#include "dcnn/data/rotation.h"
#include "dcnn/data/streaming_features.h"
#include "dcnn/teleop/teleop.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 0.002;  // s, control

/// The rigid tool and its effects at one instant, by the causal estimator that models use online.
class SimulatorCompensator : public Compensator {
 public:
  SimulatorCompensator(Simulator simulator, const DerivativeSpec& derivative)
      : simulator_(std::move(simulator)), features_(layout_for(simulator_, derivative)) {
    motion_.dt = kTick;
    motion_.t = Eigen::VectorXd::Zero(1);
    motion_.segments = {{0, 1}};
    motion_.R_BS.resize(1);
  }

  Vector3d push(const Vector3d& position, const Vector3d& euler) override {
    const Eigen::VectorXd& x = features_.push(position, euler);
    const Eigen::Matrix3d R = rotation_from_euler(euler) * simulator_.model.R_ES();
    motion_.R_BS[0] = R;
    motion_.euler = euler.transpose();
    motion_.v_B = (R * x.segment<3>(3)).transpose();
    motion_.w_S = x.segment<3>(6).transpose();
    motion_.a_B = (R * x.segment<3>(9)).transpose();
    motion_.dw_S = x.segment<3>(12).transpose();
    const Vector3d force = simulate(simulator_, motion_).force.row(0);
    motion_.t[0] += kTick;
    return force;
  }

 private:
  static FeatureLayout layout_for(const Simulator& simulator, const DerivativeSpec& derivative) {
    FeatureLayout layout;
    layout.spec.set = FeatureSpec::Set::kBody;
    layout.spec.sensor_rotation_rpy = simulator.model.sensor_rotation_rpy;
    layout.spec.derivative = derivative;
    layout.dt = kTick;
    for (const Block& block : feature_blocks(layout.spec, System())) {
      layout.names.insert(layout.names.end(), block.names.begin(), block.names.end());
      layout.units.insert(layout.units.end(), block.names.size(), block.unit);
    }
    return layout;
  }

  Simulator simulator_;
  StreamingFeatures features_;
  Motion motion_;
};

/// What one sample does not show: states of their own, and a clock that ended with the recording.
void require_instantaneous(const Simulator& simulator, const std::string& where, Exit exit) {
  constexpr std::array<const char*, 7> kWithMemory{
      "hysteresis",   "lugre_friction", "loose_load", "thermal_drift",
      "linear_drift", "step_bias",      "hum"};
  for (const EffectSpec& effect : simulator.effects) {
    const EffectKind* kind = find_effect(effect.effect);
    const bool remembers = effect.interval_s || !kind || kind->stage == Stage::kResonance ||
                           kind->stage == Stage::kDynamics ||
                           std::any_of(kWithMemory.begin(), kWithMemory.end(),
                                       [&](const char* name) { return effect.effect == name; });
    require(!remembers, exit, where, ": its effect '", effect.effect,
            "' has a memory or a time of its own, which one sample does not show; leave it out");
  }
}

class ModelCompensator : public Compensator {
 public:
  ModelCompensator(const Identifier& identifier, const std::string& where)
      : predictor_(identifier.model->predictor()), features_(identifier.layout), where_(where) {
    constexpr std::array<const char*, 3> kForce{"fx", "fy", "fz"};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& names = identifier.targets.names;
      const auto found = std::find(names.begin(), names.end(), kForce[i]);
      require(found != names.end(), Exit::kModel, where, ": predicts no '", kForce[i],
              "'; give a model of a wrist tool's force");
      columns_[i] = found - names.begin();
    }
    if (!identifier.base) return;
    require_instantaneous(*identifier.base, where, Exit::kModel);
    base_ =
        std::make_unique<SimulatorCompensator>(*identifier.base, identifier.layout.spec.derivative);
  }

  Vector3d push(const Vector3d& position, const Vector3d& euler) override {
    const Eigen::VectorXd& predicted = predictor_->push(features_.push(position, euler));
    Vector3d force(predicted[columns_[0]], predicted[columns_[1]], predicted[columns_[2]]);
    if (base_) force += base_->push(position, euler);
    require(force.allFinite(), Exit::kModel, where_, ": its prediction is not finite");
    return force;
  }

 private:
  std::unique_ptr<Predictor> predictor_;
  StreamingFeatures features_;
  std::string where_;
  std::array<Index, 3> columns_{};
  std::unique_ptr<SimulatorCompensator> base_;
};

}  // namespace

std::unique_ptr<Compensator> compensate_with(const Identifier& identifier,
                                             const std::string& where) {
  const FeatureLayout& layout = identifier.layout;
  require(layout.spec.set != FeatureSpec::Set::kAxes && layout.dt > 0.0, Exit::kModel, where,
          ": no model of a wrist tool in motion; train one on recordings of a pose");
  require(layout.spec.derivative.kind == DerivativeSpec::Kind::kCausalSavitzkyGolay, Exit::kModel,
          where, ": its derivatives look into the future; train it with --online");
  require(std::abs(layout.dt / kTick - 1.0) < 0.01, Exit::kModel, where, ": trained at ",
          1.0 / layout.dt, " Hz, the control runs at 500 Hz; train it on a recording at 500 Hz");
  return std::make_unique<ModelCompensator>(identifier, where);
}

std::unique_ptr<Compensator> compensate_with(const Simulator& simulator, const std::string& where) {
  require_instantaneous(simulator, where, Exit::kData);
  DerivativeSpec causal;
  causal.kind = DerivativeSpec::Kind::kCausalSavitzkyGolay;
  causal.order = 2;
  return std::make_unique<SimulatorCompensator>(simulator, causal);
}

}  // namespace dcnn
